// What strategies ask of a GPU, counted in any way, and the time that it takes at least.
#pragma once

#include <array>
#include <cstdint>

#include "cachesim/gpus/gpu.hpp"
#include "cachesim/replay/statistics.hpp"
#include "traces/object_kind.hpp"

namespace raycache::bench {

struct Demand {
    std::uint64_t rays = 0, loads = 0;
    std::array<std::uint64_t, traces::object_kinds> accesses{};  ///< of warps, by kind of object
    std::uint64_t l1 = 0, l2 = 0, dram = 0;                      ///< sectors that each is asked for

    Demand& operator+=(const cachesim::LaunchStatistics&);
};

/// Cycles of the SM clock that the busiest resource needs: instructions to issue, without those of shading and leaves;
/// sectors of L1, of the crossbar and of L2, bytes of DRAM (Williams, Waterman, Patterson 2009, "Roofline"). No latency
/// is ever waited for. The GPU must have a timing and two levels.
double roofline_cycles(const Demand&, const cachesim::Gpu&);

}  // namespace raycache::bench
