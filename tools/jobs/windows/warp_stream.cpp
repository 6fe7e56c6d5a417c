#include "tools/jobs/windows/warp_stream.hpp"

#include <algorithm>

namespace raycache::tools {

std::uint64_t count_work(WarpStream& stream, const BlockPlan& plan, const WindowSizes& sizes, WorkCount& work) {
    std::uint64_t traced = 0;
    for (const WindowPlace& place : plan.work) {
        const std::uint32_t group = std::min(sizes.work_warps, stream.warps() - place.warp);
        for (std::uint32_t i = 0; i < group; ++i) work.add(stream.trace(stream.number(place) + i));
        traced += group;
    }
    return traced;
}

}  // namespace raycache::tools
