// A replay, functional or in time, of windows of a stream of warps.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "tools/jobs/windows/warp_stream.hpp"

namespace raycache::tools {

/// A replay that is told which warps to count.
template <class Replay>
class WindowedReplay {
public:
    /// In warps. `windows`: how many it takes, from the first on. `tail`: behind the last of them.
    WindowedReplay(Replay&& replay, double warm_up, double counted, std::uint32_t tail, std::uint32_t windows)
        : replay_(std::move(replay)),
          warm_up_(std::max(1LL, std::llround(warm_up))),
          counted_(std::max(1LL, std::llround(counted))),
          tail_(tail),
          windows_(windows) {
        replay_.count_until_here();
    }

    /// Warps of a window, from the first that is counted.
    std::int64_t first() const { return -warm_up_; }
    /// Behind all but the last window the next warm-up keeps the GPU busy.
    std::int64_t end(std::uint32_t window) const { return counted_ + (window + 1 == windows_ ? tail_ : 0); }

    bool wants(std::uint32_t window, std::int64_t offset) const {
        return window < windows_ && offset >= first() && offset < end(window);
    }
    void push(const WarpPointer& warp, std::uint32_t window, std::int64_t offset) {
        if (!wants(window, offset)) return;
        if (offset == first() || offset == counted_) replay_.count_until_here();
        if (offset == 0) replay_.count_from_here();
        replay_.push(warp);
    }
    Replay& replay() { return replay_; }

private:
    Replay replay_;
    std::int64_t warm_up_, counted_, tail_;
    std::uint32_t windows_;
};

}  // namespace raycache::tools
