// Every way to answer the question of `raycache compare`, from no cache at all to exact replay in time, with the CPU
// seconds that each took.
//
// The question is about the steady state of a small picture: all N sample indices, launch after launch, through one
// replay that is never cleared, counted after a few launches. That is the truth: what exact functional replay counts,
// and exact timed replay predicts. All levels run on one thread, and the levels that see every warp see the same ones,
// traced once: `trace_seconds` belongs to each of them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tools/bench/tradeoff/demand.hpp"
#include "tools/jobs/gpu_settings.hpp"
#include "tools/jobs/launches.hpp"
#include "tools/jobs/windows/window_plan.hpp"

namespace raycache::bench {

struct LadderSettings {
    tools::LaunchSettings launches;  ///< the cases, the first of which is the baseline
    tools::GpuSettings gpu;
    tools::WindowSizes sizes;                      ///< of one block
    std::uint32_t drawings = 3;                    ///< estimates of each kind, of other blocks and places
    std::uint32_t most_blocks = 64;                ///< of an estimate
    std::vector<double> targets{0.1, 0.05, 0.02};  ///< descending
};

/// What a level says of one strategy.
struct Answer {
    double l1_hit_rate = 0, l2_hit_rate = 0, l2_bytes_per_ray = 0, dram_bytes_per_ray = 0, cycles_per_ray = 0;
};

struct LevelResult {
    std::string level;
    double target = 0;            ///< of an estimate; 0: of none
    std::uint32_t drawing = 0;    ///< of an estimate, from 1
    std::uint32_t blocks = 0;     ///< that it took
    double seconds = 0;           ///< of CPU time, user and system, tracing included
    std::vector<Answer> answers;  ///< by strategy
};

struct Ladder {
    std::vector<std::string> strategies;
    std::string gpu;
    std::uint32_t warps = 0, wave = 0;    ///< of a launch; that the GPU holds at once
    double prepare_seconds = 0;           ///< scene and BVH, which every level needs once
    double trace_seconds = 0;             ///< of all launches of all strategies
    std::uint64_t warp_instructions = 0;  ///< of the exact timed replays
    std::vector<double> issue_busy;       ///< by strategy: share of the exact cycles in which schedulers issue
    std::vector<LevelResult> levels;
};

/// Throws as the job "replay" does, and UsageError for a GPU without a timing.
Ladder climb(const LadderSettings&, tools::Observer&);

}  // namespace raycache::bench
