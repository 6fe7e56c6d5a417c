#include "cachesim/replay/timed/timed_rules.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace raycache::cachesim {

namespace {

std::uint32_t whole(double number) {
    const double most = traces::warp_lanes * 4096.0;  // more than any load asks for
    return std::floor(number) == number ? static_cast<std::uint32_t>(std::min(number, most)) : 0;
}

/// What a lane of a visit to the region has tested by an RT unit; 0: nothing.
std::uint32_t tests_of(const traces::Region& region) {
    const traces::ObjectKindRole& role = traces::role_of(region.kind);
    if (!role.is_step) return 0;
    return role.charge == traces::Charge::node ? std::max(2u, std::uint32_t{region.degree}) : 1;
}

/// Nodes and triangles as the RT unit loads them: all lanes of a warp together.
FrontEnd front_end_of(const RtUnitTiming& unit) {
    FrontEnd front_end;
    front_end.load_bytes = unit.load_bytes;
    return front_end;
}

}  // namespace

std::uint32_t visit_instructions(const Timing& timing, traces::ObjectKind kind, unsigned children) {
    switch (traces::role_of(kind).charge) {
        case traces::Charge::node:
            return children <= 2   ? timing.node_instructions
                   : children <= 4 ? timing.node4_instructions
                                   : timing.node8_instructions;
        case traces::Charge::triangle:
            return timing.triangle_instructions;
        case traces::Charge::texel:
            return timing.texel_instructions;
    }
    return 0;
}

TimedRules::TimedRules(const Gpu& g, const std::vector<traces::Region>& regions, const LineIds& line_ids,
                       const Idealised& idealised, PortPath port_path)
    : gpu(g),
      ids(line_ids),
      timing(*g.timing),
      ideal(idealised),
      path(port_path),
      sectors_per_line(g.l1().line_bytes / g.l1().sector_bytes),
      line_of_sector(std::countr_zero(sectors_per_line)),
      cta_slots(std::max(1u, g.warps_per_sm / g.warps_per_cta)),
      tag_cost(1.0 / timing.tags_per_cycle),
      data_cost(g.l1().sector_bytes / timing.l1_bytes_per_cycle),
      port_sectors(whole(timing.l1_bytes_per_cycle / g.l1().sector_bytes)) {
    for (const CacheGeometry& level : g.levels) {
        maps.emplace_back(level, ids.last_line());
        fill_sectors.push_back(std::max(1u, level.fill_bytes / level.sector_bytes));
    }
    for (std::size_t i = 0; i < regions.size(); ++i) {
        const bool rt = g.traversal == Traversal::rt_unit;
        if (rt) {
            tests.push_back(tests_of(regions[i]));
            triangle.push_back(traces::role_of(regions[i].kind).charge == traces::Charge::triangle);
        }
        if (rt) sm_shapes.emplace_back(regions[i], i, g.front_end, g.l1(), ids);
        shapes.emplace_back(regions[i], i, rt && tests[i] > 0 ? front_end_of(*g.rt_unit) : g.front_end, g.l1(), ids);
        instructions.push_back(visit_instructions(timing, regions[i].kind, regions[i].degree));
    }
    if (timing.leaf_instructions > 0) leaves.emplace(regions);
}

}  // namespace raycache::cachesim
