#include "tools/jobs/windows/warp_stream.hpp"

#include <algorithm>

namespace raycache::tools {

std::uint64_t trace_work(WarpStream& stream, const BlockPlan& plan, const WindowSizes& sizes,
                         const std::function<void(const traces::WarpTrace&)>& use) {
    std::uint64_t traced = 0;
    for (const WindowPlace& place : plan.work) {
        const std::uint32_t group = std::min(sizes.work_warps, stream.warps() - place.warp);
        for (std::uint32_t i = 0; i < group; ++i) use(stream.trace(stream.number(place) + i));
        traced += group;
    }
    return traced;
}

std::uint64_t count_work(WarpStream& stream, const BlockPlan& plan, const WindowSizes& sizes, WorkCount& work) {
    return trace_work(stream, plan, sizes, [&](const traces::WarpTrace& warp) { work.add(warp); });
}

}  // namespace raycache::tools
