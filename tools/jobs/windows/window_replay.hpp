// One block of sample indices of one strategy: traced in places, replayed in windows, told as one sample index of every
// pixel in the steady state, whatever a launch of the thread map holds.
//
// A window is a run of neighbouring warps in launch order, at any place of any index of the block. Before it a
// warm-up is replayed and not counted; behind the last one more wave, so that nothing drains while anything is counted.
// The windows of a block go one after another through a replay that is never cleared, so that the last cache is as full
// as in the steady state. It is filled first, wave by wave, until misses no longer find empty ways.
//
// What is counted is scaled to the work that tracing alone finds at many places (work_count.hpp), and to the pixels of
// the picture.
#pragma once

#include <cstdint>
#include <vector>

#include "cachesim/analysis/element_depth.hpp"
#include "cachesim/analysis/findings.hpp"
#include "cachesim/gpus/gpu.hpp"
#include "cachesim/replay/statistics.hpp"
#include "cachesim/replay/timed/timed_rules.hpp"
#include "cachesim/replay/timed/timed_statistics.hpp"
#include "tools/jobs/windows/window_plan.hpp"
#include "tracer/capture.hpp"

namespace raycache::tools {

/// What is asked beside the counts.
struct WindowReplays {
    std::vector<cachesim::Idealised> timed;         ///< a replay in time each; empty: no time
    const cachesim::ElementDepth* depth = nullptr;  ///< of the capture, where findings are wanted, else null
};

/// What a block says of one GPU.
struct BlockResult {
    cachesim::LaunchStatistics counts;
    std::vector<cachesim::TimedStatistics> times;  ///< of WindowReplays::timed
    double issue_cycles = 0;                       ///< IssueWork of the launch; of GPUs with a timing
    cachesim::Findings findings;                   ///< scaled as the counts are; empty unless asked for
    /// Of the last cache's misses, those that took a way that held nothing, after the filling. Above
    /// WindowSizes::unfilled_share the scene fits in it, and what DRAM serves in the steady state is not known.
    double unfilled_share = 0;
};

/// By GPU. `first_launch`: the launch of the capture that has the block's first sample index; the others follow it.
/// Nothing depends on the other GPUs, or on threads. Throws Error as Replay does.
std::vector<BlockResult> replay_block(const tracer::Capture&, std::uint32_t first_launch, const WindowPlan&,
                                      const BlockPlan&, const WindowSizes&, const std::vector<cachesim::Gpu>&,
                                      const WindowReplays&);

/// The same of IssueWork alone: BlockResult::issue_cycles by GPU, from tracing. All GPUs must have a timing.
std::vector<double> count_issue_cycles(const tracer::Capture&, std::uint32_t first_launch, const WindowPlan&,
                                       const BlockPlan&, const WindowSizes&, const std::vector<cachesim::Gpu>&);

/// Warps that a GPU holds at once.
std::uint32_t wave_warps(const cachesim::Gpu&);

}  // namespace raycache::tools
