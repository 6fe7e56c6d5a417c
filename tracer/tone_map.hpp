// Linear light -> 8-bit pixels for a screen.
#pragma once

#include <array>
#include <cstdint>

#include "tracer/vec.hpp"

namespace raycache::tracer {

/// Multiplies by 2^exposure_stops, applies a filmic curve to each channel (the rational fit to the ACES reference
/// transform published by K. Narkowicz, "ACES Filmic Tone Mapping Curve", 2016) and encodes as sRGB
/// (IEC 61966-2-1). Negative values and NaN give 0, infinity gives 255.
std::array<std::uint8_t, 3> tone_map(Vec3 linear, float exposure_stops);

}  // namespace raycache::tracer
