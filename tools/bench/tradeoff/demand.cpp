#include "tools/bench/tradeoff/demand.hpp"

#include <algorithm>

#include "cachesim/replay/timed/timed_rules.hpp"

namespace raycache::bench {

Demand& Demand::operator+=(const cachesim::LaunchStatistics& launch) {
    for (const cachesim::RayGroup& group : launch.groups) {
        rays += group.rays;
        for (std::size_t k = 0; k < accesses.size(); ++k) accesses[k] += group.by_kind[k].warp_accesses;
    }
    const cachesim::Counters all = launch.all();
    loads += all.loads;
    l1 += all.levels[0].sectors;
    l2 += all.levels[1].sectors;
    dram += all.dram_sectors;
    return *this;
}

double roofline_cycles(const Demand& d, const cachesim::Gpu& gpu) {
    const cachesim::Timing& t = *gpu.timing;
    const double sector = gpu.l1().sector_bytes, sms = gpu.sms;
    constexpr unsigned boxes_of_node = 2;  // of layout bvh2
    auto instructions = static_cast<double>(d.loads);
    for (std::size_t k = 0; k < d.accesses.size(); ++k)
        instructions += static_cast<double>(d.accesses[k]) *
                        cachesim::visit_instructions(t, static_cast<traces::ObjectKind>(k), boxes_of_node);
    const double l2_bytes = sector * static_cast<double>(d.l2);
    const double dram_bytes_per_cycle = 1e3 * t.dram_gb_s / t.clock_mhz;
    return std::max({instructions * t.instruction_interval / (t.schedulers * sms),
                     sector * static_cast<double>(d.l1) / (t.l1_bytes_per_cycle * sms),
                     l2_bytes / (t.crossbar_bytes_per_cycle * sms),
                     l2_bytes / (t.l2_bytes_per_cycle * gpu.levels[1].slices),
                     sector * static_cast<double>(d.dram) / dram_bytes_per_cycle});
}

}  // namespace raycache::bench
