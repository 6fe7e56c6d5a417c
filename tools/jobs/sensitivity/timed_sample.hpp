// The warps of one block's windows in time, traced once and replayed on any number of GPUs.
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "cachesim/replay/timed/timed_statistics.hpp"
#include "tools/jobs/sensitivity/scale_model.hpp"
#include "tools/jobs/windows/warp_stream.hpp"
#include "tools/jobs/windows/windowed_case.hpp"

namespace raycache::tools {

/// The windows that replay_block() replays in time, and nothing else: for a whole GPU and the same sizes, its times.
class TimedSample {
public:
    /// Traces what any of `gpus` asks for, on the threads of the TBB arena. The case, the sizes and the plan must outlive
    /// this object.
    TimedSample(const WindowedCase&, std::size_t block, const BlockPlan&, const WindowSizes&,
                const std::vector<ModelledGpu>& gpus);

    /// Warps that a replay takes: what it costs.
    static std::uint64_t warps_of(const ModelledGpu&, const WindowSizes&);
    /// One of the GPUs: cycles scaled to a launch of the block. Thread-safe. Throws Error as TimedReplay does.
    cachesim::TimedStatistics replay(const ModelledGpu&) const;

private:
    /// Calls use(fill, window, offset, number) for every warp in the order of the replay. `number`: in the stream.
    template <class Use>
    void for_each_warp(const ModelledGpu&, const Use&) const;

    const WindowedCase& case_;
    const BlockPlan& plan_;
    const WindowSizes& sizes_;
    std::uint32_t launch_warps_;
    std::uint64_t round_;  ///< warps of all launches of the block
    std::unordered_map<std::uint64_t, WarpPointer> warps_;
    WorkCount work_;
    double scale_ = 1;  ///< of the work counted to that of a launch
};

}  // namespace raycache::tools
