// Whole launches from cold caches beside the steady state of the same strategy: what a renderer pays that runs launch
// after launch with a pause between them, or each time another one.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "cachesim/analysis/estimate.hpp"
#include "cachesim/replay/statistics.hpp"
#include "cachesim/replay/timed/launch_stages.hpp"

namespace raycache::cachesim {

/// Of a series of estimates from windows: launches of the same strategy on the same GPU, whole, each from cold caches.
struct ColdLaunches {
    std::vector<LaunchStatistics> launches;  ///< one per sample index, ascending
    std::vector<LaunchStages> stages;        ///< in the same order; none where no time is predicted
};

/// What they say, all of them together. Intervals are those of the steady state: the launches are what they are.
struct ColdFigures {
    std::vector<std::uint32_t> samples;  ///< first sample index of each

    /// launch_factors.hpp.
    struct Time {
        std::uint64_t cycles = 0;
        Estimate steady_cycles, over_steady, cold;
        Estimate ramp, tail, full_share;  ///< without intervals: they do not ask for the steady state
        /// Cycles of the baseline's launches of the same sample indices over these; absent without a baseline. Its
        /// interval is over launches: absent for one.
        std::optional<Estimate> speed_up;
    };
    std::optional<Time> time;  ///< absent where none is predicted

    struct Bytes {
        Estimate per_ray;  ///< with an interval over launches, as in whole launches
        /// Bytes per warp access over those of the steady state. Absent where the steady state is not known: DRAM bytes
        /// below a cache that does not fill up.
        std::optional<Estimate> over_steady;
    };
    std::vector<Bytes> bytes;  ///< by level, as bytes_figures() has them
};

}  // namespace raycache::cachesim
