#include "cachesim/replay/tally.hpp"

namespace raycache::cachesim {

Counters Tally::counters(const Sums& sums, traces::ObjectKind kind, std::size_t levels) const {
    struct Fields {
        std::uint64_t Counters::*asked, Counters::*found;
    };
    static constexpr Fields fields[most_levels] = {{&Counters::sectors, &Counters::l1_hits},
                                                   {&Counters::l2_sectors, &Counters::l2_hits},
                                                   {&Counters::l3_sectors, &Counters::l3_hits}};
    Counters c;
    c.lane_accesses = sums.lane_accesses;
    c.warp_accesses = sums.warp_accesses;
    c.loads = sums.loads;
    c.l1_requests = sums.requests;
    if (kind == traces::ObjectKind::node || kind == traces::ObjectKind::triangle) c.steps = sums.lane_accesses;
    std::uint64_t asked = sums.sectors;
    for (std::size_t level = 0; level < levels; ++level) {
        c.*fields[level].asked = asked;
        c.*fields[level].found = asked - (sums.fetched[level] - sums.unasked[level]);
        asked = sums.fetched[level];
    }
    c.dram_sectors = asked;
    if (traces::is_write(kind)) c.written_sectors = asked;
    if (kind == traces::ObjectKind::sort) c.sort_sectors = asked;
    return c;
}

std::vector<RayGroup> Tally::groups(std::size_t levels) const {
    std::vector<RayGroup> result;
    for (unsigned ray = 0; ray < traces::ray_types; ++ray) {
        for (unsigned bounce = 0; bounce <= traces::max_bounce; ++bounce) {
            const std::uint16_t first = first_group_[ray * (traces::max_bounce + 1) + bounce];
            if (first == absent) continue;
            RayGroup group;
            group.ray = static_cast<traces::RayType>(ray);
            group.bounce = static_cast<std::uint8_t>(bounce);
            for (unsigned kind = 0; kind < traces::object_kinds; ++kind) {
                const Sums& sums = sums_[first + kind];
                group.by_kind[kind] = counters(sums, static_cast<traces::ObjectKind>(kind), levels);
                group.rays += sums.rays;
            }
            result.push_back(group);
        }
    }
    return result;
}

}  // namespace raycache::cachesim
