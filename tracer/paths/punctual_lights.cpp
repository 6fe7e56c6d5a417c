// Lights of no size, as KHR_lights_punctual describes them: intensities, cones and ranges are its formulas.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "tracer/paths/lights.hpp"

namespace raycache::tracer {

namespace {

/// Share of the light that reaches a point in `direction` (unit, away from the light) at `distance`.
float reach(const PunctualLight& light, Vec3 direction, float distance) {
    float share = 1;
    if (light.range > 0) {
        const float part = distance / light.range, squared = part * part;
        share = std::clamp(1 - squared * squared, 0.0F, 1.0F);
    }
    if (light.kind == PunctualLight::Kind::spot) {
        constexpr float softest = 0.001F;
        const float cone =
            (dot(direction, light.direction) - light.cos_outer) / std::max(softest, light.cos_inner - light.cos_outer);
        const float angular = std::clamp(cone, 0.0F, 1.0F);
        share *= angular * angular;
    }
    return share;
}

}  // namespace

void Lights::add_punctual(const Scene& scene, std::vector<double>& power) {
    constexpr double pi = std::numbers::pi;
    const Box box = scene.bounds();
    const double radius = double{length((box.upper - box.lower) * 0.5F)};
    for (const PunctualLight& light : scene.punctual_lights) {
        const double brightness = double{luminance(light.intensity)};
        if (!(brightness > 0)) continue;
        double watts = 4 * pi * brightness;
        if (light.kind == PunctualLight::Kind::spot) watts = 2 * pi * (1 - double{light.cos_outer}) * brightness;
        if (light.kind == PunctualLight::Kind::directional) watts = pi * radius * radius * brightness;
        if (!(watts > 0)) continue;
        punctual_.push_back(light);
        power.push_back(watts / (2 * pi));  // a triangle of area A and radiance L sends 2 pi A L from both sides
    }
}

LightSample Lights::sample_punctual(const PunctualLight& light, float share, Vec3 from) const {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    if (light.kind == PunctualLight::Kind::directional)
        return {-light.direction, infinity, light.direction, light.intensity * (1 / share), infinity};
    const Vec3 way = light.position - from;
    const float distance = length(way);
    if (!(distance > 0)) return {};
    const Vec3 direction = way / distance;
    const float weight = reach(light, -direction, distance) / distance / distance / share;
    return {direction, distance, direction, light.intensity * weight, infinity};
}

}  // namespace raycache::tracer
