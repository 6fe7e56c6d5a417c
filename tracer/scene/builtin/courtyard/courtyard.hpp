// The built-in scene `courtyard`: an arcaded yard in the sun with trees, tables and a fountain.
#pragma once

#include <cstdint>

#include "tracer/scene/scene.hpp"

namespace raycache::tracer::courtyard {

inline constexpr std::uint64_t min_detail = 50'000, default_detail = 500'000, max_detail = 10'500'000;

/// Builds the scene of about `detail` triangles (within 5 %; clamped to [min_detail, max_detail]), or of default_detail
/// where `detail` is 0. The same bits on every machine: no C library function with a rounding of its own is used.
Scene build(std::uint64_t detail);

}  // namespace raycache::tracer::courtyard
