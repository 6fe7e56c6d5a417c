// How the samples of a picture are cut into launches.
#pragma once

#include <cstdint>

#include "tracer/capture.hpp"
#include "tracer/simt/thread_map.hpp"

namespace raycache::tools {

tracer::LaunchGrid launch_grid_of(const tracer::CaptureSettings&);

struct LaunchExtent {
    std::uint32_t launches = 0;  ///< of all N sample indices
    std::uint32_t warps = 0;     ///< of a launch
    std::uint32_t indices = 0;   ///< sample indices of a launch
    std::uint32_t rounds = 0;    ///< through all launches that walk_steady() counts at least
};
LaunchExtent extent_of(const tracer::CaptureSettings&);

}  // namespace raycache::tools
