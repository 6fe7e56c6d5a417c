#include "tracer/tone_map.hpp"

#include <algorithm>
#include <cmath>

namespace raycache::tracer {

namespace {

double filmic(double x) {
    if (x > 1e6) return 1;
    return std::clamp((x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14), 0.0, 1.0);
}

double srgb(double linear) { return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055; }

}  // namespace

std::array<std::uint8_t, 3> tone_map(Vec3 linear, float exposure_stops) {
    const double exposure = std::exp2(double{exposure_stops});
    const auto channel = [&](float value) {
        const double exposed = double{value} * exposure;
        if (!(exposed > 0)) return std::uint8_t{0};
        return static_cast<std::uint8_t>(std::lround(255 * srgb(filmic(exposed))));
    };
    return {channel(linear.x), channel(linear.y), channel(linear.z)};
}

}  // namespace raycache::tracer
