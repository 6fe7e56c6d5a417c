// Timed replay of one launch on one GPU: cycles, and what they are spent on.
//
// The same warps, CTAs and placement as the functional replay (cachesim/replay/replay.hpp); what hits where follows
// from when it is asked for. SMs run a window of cycles each, as long as no reply can come back within it; then the
// requests of all of them go to L2 in order of time (cachesim/replay/timed/memory_side.hpp). Memory does not grow with
// the trace.
//
// CTA c starts on SM c mod n in cycle c div n, while there is room; a later one takes the slot that frees first, from
// the end of that window on.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "cachesim/gpus/gpu.hpp"
#include "cachesim/replay/timed/memory_side.hpp"
#include "cachesim/replay/timed/timed_statistics.hpp"
#include "traces/header.hpp"
#include "traces/record.hpp"

namespace raycache::cachesim {

class TimedReplay {
public:
    /// Throws Error if the GPU breaks a rule of cachesim/gpus/limits.hpp, has no [timing], or its policies are not
    /// timed.
    TimedReplay(const Gpu&, const std::vector<traces::Region>& regions, std::uint32_t sample, const Idealised& = {});
    ~TimedReplay();
    TimedReplay(TimedReplay&&) noexcept;

    /// Hands over the next warp of the launch, in warp order.
    void push(std::shared_ptr<const traces::WarpTrace>);

    /// The warps pushed so far are a kernel, and the next is launched when they have ended, on SM 0: L1s empty, L2
    /// kept. What kernels write and sorts move: streamed_traffic.hpp.
    void end_kernel();

    /// No more warps: runs to the end.
    TimedStatistics finish();

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace raycache::cachesim
