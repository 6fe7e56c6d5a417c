#include "cachesim/replay/tally.hpp"

namespace raycache::cachesim {

std::vector<RayGroup> Tally::groups() const {
    std::vector<RayGroup> result;
    for (unsigned ray = 0; ray < traces::ray_types; ++ray) {
        for (unsigned bounce = 0; bounce <= traces::max_bounce; ++bounce) {
            const std::uint16_t first = first_group_[ray * (traces::max_bounce + 1) + bounce];
            if (first == absent) continue;
            RayGroup group;
            group.ray = static_cast<traces::RayType>(ray);
            group.bounce = static_cast<std::uint8_t>(bounce);
            for (unsigned kind = 0; kind < traces::object_kinds; ++kind) {
                Counters& c = group.by_kind[kind] = counters_[first + kind];
                group.rays += c.rays;
                c.rays = 0;
                const auto object = static_cast<traces::ObjectKind>(kind);
                const bool step = object == traces::ObjectKind::node || object == traces::ObjectKind::triangle;
                c.steps = step ? c.lane_accesses : 0;
                c.l1_hits = c.sectors - c.l2_sectors;
                c.l2_hits = c.l2_sectors - c.dram_sectors;
            }
            result.push_back(group);
        }
    }
    return result;
}

}  // namespace raycache::cachesim
