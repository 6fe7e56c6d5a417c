#include "cachesim/replay/tally.hpp"

#include <algorithm>

namespace raycache::cachesim {

Tally::Sums& Tally::Sums::operator+=(const Sums& other) {
    rays += other.rays;
    lane_accesses += other.lane_accesses;
    warp_accesses += other.warp_accesses;
    requests += other.requests;
    sectors += other.sectors;
    first += other.first;
    for (std::size_t level = 0; level < most_levels; ++level) {
        fetched[level] += other.fetched[level];
        unasked[level] += other.unasked[level];
    }
    return *this;
}

Tally& Tally::operator+=(const Tally& other) {
    sums_.resize(std::max(sums_.size(), other.sums_.size()));
    for (std::size_t group = 0; group < other.sums_.size(); ++group) sums_[group] += other.sums_[group];
    return *this;
}

Counters Tally::counters(const Sums& sums, traces::ObjectKind kind, std::size_t region, std::size_t levels,
                         const LoadCounter& loads) {
    Counters c;
    c.lane_accesses = sums.lane_accesses;
    c.warp_accesses = sums.warp_accesses;
    c.loads = sums.warp_accesses * loads.loads(region);
    c.requests = loads.requests_follow(region) ? loads.requests(region, sums.sectors) : sums.requests;
    if (traces::role_of(kind).is_step) c.steps = sums.lane_accesses;
    std::uint64_t asked = sums.sectors;
    for (std::size_t level = 0; level < levels; ++level) {
        c.levels[level] = {asked, asked - (sums.fetched[level] - sums.unasked[level])};
        asked = sums.fetched[level];
    }
    c.dram_sectors = asked;
    c.dram_first_sectors = sums.first;
    if (traces::is_write(kind)) c.written_sectors = asked;
    if (traces::is_stream(kind)) c.sort_sectors = asked;
    return c;
}

std::vector<RayGroup> Tally::groups(const std::vector<const BatchGroups*>& batches,
                                    const std::vector<traces::ObjectKind>& kinds, std::size_t levels,
                                    const LoadCounter& loads) const {
    std::vector<RayGroup> result;
    for (unsigned ray = 0; ray < traces::ray_types; ++ray) {
        for (unsigned bounce = 0; bounce <= traces::max_bounce; ++bounce) {
            RayGroup group;
            group.ray = static_cast<traces::RayType>(ray);
            group.bounce = static_cast<std::uint8_t>(bounce);
            bool occurs = false;
            std::vector<Sums> sums(per_ray_);
            for (const BatchGroups* const batch : batches) {
                const std::uint32_t first = batch->find(group.ray, bounce);
                if (first == BatchGroups::absent) continue;
                occurs = true;
                for (std::size_t i = 0; i < per_ray_ && first + i < sums_.size(); ++i) sums[i] += sums_[first + i];
            }
            if (!occurs) continue;
            for (std::size_t region = 0; region < kinds.size(); ++region)
                group.by_kind[static_cast<unsigned>(kinds[region])] +=
                    counters(sums[region], kinds[region], region, levels, loads);
            group.rays = sums.back().rays;
            result.push_back(group);
        }
    }
    return result;
}

}  // namespace raycache::cachesim
