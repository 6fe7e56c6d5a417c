#include "cachesim/replay/timed/timed_rules.hpp"

#include <algorithm>
#include <bit>

namespace raycache::cachesim {

namespace {

std::uint32_t instructions_of(const Timing& timing, traces::ObjectKind kind) {
    switch (kind) {
        case traces::ObjectKind::node:
            return timing.node_instructions;
        case traces::ObjectKind::triangle:
            return timing.triangle_instructions;
        default:
            return timing.texel_instructions;
    }
}

}  // namespace

TimedRules::TimedRules(const Gpu& g, const std::vector<traces::Region>& regions, const LineIds& ids,
                       const Idealised& idealised)
    : gpu(g),
      timing(*g.timing),
      ideal(idealised),
      sectors_per_line(g.l1().line_bytes / g.l1().sector_bytes),
      line_of_sector(std::countr_zero(sectors_per_line)),
      cta_slots(std::max(1u, g.warps_per_sm / g.warps_per_cta)),
      port_sectors(std::max(1u, static_cast<std::uint32_t>(timing.l1_bytes_per_cycle / g.l1().sector_bytes))) {
    for (const CacheGeometry& level : g.levels) maps.emplace_back(level, ids.last_line());
    for (std::size_t i = 0; i < regions.size(); ++i) {
        shapes.emplace_back(regions[i], i, g.front_end, g.l1(), ids);
        instructions.push_back(instructions_of(timing, regions[i].kind));
    }
}

}  // namespace raycache::cachesim
