#include "tools/jobs/windows/launch_extent.hpp"

#include "tracer/sampling/pixel_place.hpp"

namespace raycache::tools {

tracer::LaunchGrid launch_grid_of(const tracer::CaptureSettings& s) {
    return {s.thread_map, s.width, s.height, s.strategy.samples.spp, tracer::interleave_of(s.strategy.parameters)};
}

LaunchExtent extent_of(const tracer::CaptureSettings& s) {
    const tracer::LaunchGrid grid = launch_grid_of(s);
    const std::uint32_t each = grid.samples_per_launch();
    return {static_cast<std::uint32_t>((s.strategy.samples.spp + each - 1) / each), grid.warps(), each, 0};
}

}  // namespace raycache::tools
