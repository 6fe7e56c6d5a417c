// The warps of a block's launches, traced where they are wanted.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include "tools/jobs/windows/window_plan.hpp"
#include "tools/jobs/windows/work_count.hpp"
#include "tracer/capture.hpp"

namespace raycache::tools {

using WarpPointer = std::shared_ptr<const traces::WarpTrace>;

/// The launches of a block one after the other, round and round: warps without an end.
class WarpStream {
public:
    WarpStream(const tracer::Capture& capture, std::uint32_t first_launch, std::uint32_t launches)
        : capture_(capture),
          worker_(capture.make_worker()),
          first_launch_(first_launch),
          launches_(launches),
          warps_(capture.header().warps_per_launch) {}

    /// The number in the stream of a place, in its first round.
    std::uint64_t number(const WindowPlace& place) const { return std::uint64_t{place.index} * warps_ + place.warp; }
    traces::WarpTrace trace(std::uint64_t number) {
        traces::WarpTrace warp;
        const auto launch = static_cast<std::uint32_t>(number / warps_ % launches_);
        capture_.trace_warp(*worker_, first_launch_ + launch, static_cast<std::uint32_t>(number % warps_), warp);
        return warp;
    }
    std::uint32_t warps() const { return warps_; }  ///< of a launch
    std::uint64_t round() const { return std::uint64_t{launches_} * warps_; }

private:
    const tracer::Capture& capture_;
    std::unique_ptr<tracer::Capture::Worker> worker_;
    std::uint32_t first_launch_, launches_, warps_;
};

/// Traces the places of a block's plan where work is counted, and shows each warp to `use`. Returns how many. The last
/// group of a picture may be shorter, so that every warp is in one group.
std::uint64_t trace_work(WarpStream&, const BlockPlan&, const WindowSizes&,
                         const std::function<void(const traces::WarpTrace&)>& use);
/// Counts the work there.
std::uint64_t count_work(WarpStream&, const BlockPlan&, const WindowSizes&, WorkCount&);

}  // namespace raycache::tools
