// The built-in scene `room`: a furnished living room by day, lit through two windows and by three lamps.
#pragma once

#include <cstdint>

#include "tracer/scene/scene.hpp"

namespace raycache::tracer::room {

inline constexpr std::uint64_t min_detail = 100'000, default_detail = 500'000, max_detail = 10'000'000;

/// Builds the scene of about `detail` triangles (within 5 %; clamped to [min_detail, max_detail]), or of default_detail
/// where `detail` is 0. The same bits on every machine: no C library function with a rounding of its own is used.
Scene build(std::uint64_t detail);

}  // namespace raycache::tracer::room
