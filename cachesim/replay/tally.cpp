#include "cachesim/replay/tally.hpp"

namespace raycache::cachesim {

Counters Tally::counters(const Sums& sums, std::size_t region, std::size_t levels, const LoadCounter& loads) const {
    const traces::ObjectKind kind = kinds_[region];
    struct Fields {
        std::uint64_t Counters::*asked, Counters::*found;
    };
    static constexpr Fields fields[most_levels] = {{&Counters::sectors, &Counters::l1_hits},
                                                   {&Counters::l2_sectors, &Counters::l2_hits},
                                                   {&Counters::l3_sectors, &Counters::l3_hits}};
    Counters c;
    c.lane_accesses = sums.lane_accesses;
    c.warp_accesses = sums.warp_accesses;
    c.loads = sums.warp_accesses * loads.loads(region);
    c.l1_requests = loads.requests_follow(region) ? loads.requests(region, sums.sectors) : sums.requests;
    if (traces::role_of(kind).is_step) c.steps = sums.lane_accesses;
    std::uint64_t asked = sums.sectors;
    for (std::size_t level = 0; level < levels; ++level) {
        c.*fields[level].asked = asked;
        c.*fields[level].found = asked - (sums.fetched[level] - sums.unasked[level]);
        asked = sums.fetched[level];
    }
    c.dram_sectors = asked;
    c.dram_first_sectors = sums.first;
    if (traces::is_write(kind)) c.written_sectors = asked;
    if (traces::is_stream(kind)) c.sort_sectors = asked;
    return c;
}

std::vector<RayGroup> Tally::groups(std::size_t levels, const LoadCounter& loads) const {
    std::vector<RayGroup> result;
    for (unsigned ray = 0; ray < traces::ray_types; ++ray) {
        for (unsigned bounce = 0; bounce <= traces::max_bounce; ++bounce) {
            const std::uint32_t first = first_group_[ray * (traces::max_bounce + 1) + bounce];
            if (first == absent) continue;
            RayGroup group;
            group.ray = static_cast<traces::RayType>(ray);
            group.bounce = static_cast<std::uint8_t>(bounce);
            for (std::size_t region = 0; region < kinds_.size(); ++region)
                group.by_kind[static_cast<unsigned>(kinds_[region])] +=
                    counters(sums_[first + region], region, levels, loads);
            group.rays = sums_[first + kinds_.size()].rays;
            result.push_back(group);
        }
    }
    return result;
}

}  // namespace raycache::cachesim
