// Timed replay of one launch on one GPU: cycles, and what they are spent on.
//
// The same warps, CTAs and placement as the functional replay (cachesim/replay/replay.hpp); what hits where follows
// from when it is asked for. SMs run a window of cycles each, as long as no reply can come back within it; then the
// requests of all of them go to L2 in order of time (cachesim/replay/timed/memory_side.hpp). Within a window SMs know
// nothing of each other, so the threads of the current TBB arena share them, with the same counts (each_sm.hpp). Memory
// does not grow with the trace.
//
// Statistics are kept for batches, each a stretch of time: from the cycle in which the CTA of the first warp pushed
// after count_from_here() becomes resident to that of the first warp pushed after count_until_here(), or to the end.
// What happens in it is counted, whichever warp it is for: SMs are not drained in between. The time before a kernel's
// first CTA (Timing::launch_cycles) belongs to the batch of that CTA. All of the launch is one batch unless the caller
// says otherwise.
//
// CTA c starts on SM c mod n in cycle c div n, while there is room; a later one takes the slot that frees first, from
// the end of that window on.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "cachesim/gpus/gpu.hpp"
#include "cachesim/replay/timed/dram_sink.hpp"
#include "cachesim/replay/timed/memory_side.hpp"
#include "cachesim/replay/timed/timed_statistics.hpp"
#include "traces/header.hpp"
#include "traces/record.hpp"

namespace raycache::cachesim {

class TimedReplay {
public:
    /// Throws Error if the GPU breaks a rule of cachesim/gpus/limits.hpp, has no [timing], or its policies are not
    /// timed.
    TimedReplay(const Gpu&, const std::vector<traces::Region>& regions, std::uint32_t sample, const Idealised& = {},
                PortPath = PortPath::fast);
    ~TimedReplay();
    TimedReplay(TimedReplay&&) noexcept;

    /// The sink hears of all that DRAM is asked for, and changes no count. Call before the first push; it must outlive
    /// the replay.
    void observe(DramSink&);

    /// Hands over the next warp of the launch, in warp order.
    void push(std::shared_ptr<const traces::WarpTrace>);

    /// The warps pushed so far are a kernel, and the next is launched when they have ended, on SM 0: L1s empty, L2
    /// kept (of a CPU, with three levels, all is kept). What kernels write and sorts move: streamed_traffic.hpp.
    void end_kernel();

    /// With the CTA of the next warp a batch begins, the next one. A batch of no warp is none. Caches, SMs and whatever
    /// is under way stay as they are.
    void count_from_here();
    /// With the CTA of the next warp the batch ends, and nothing is counted until the next one begins.
    void count_until_here();

    /// No more warps: runs to the end. The counts of all batches together. Call once.
    TimedStatistics finish();

    /// The counts of each batch that has ended; after finish(), of all.
    const std::vector<TimedStatistics>& batches() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace raycache::cachesim
