#include "tracer/scene/gltf_lights.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace raycache::tracer {

namespace {

PunctualLight::Kind kind_of(const std::string& type) {
    return type == "spot"          ? PunctualLight::Kind::spot
           : type == "directional" ? PunctualLight::Kind::directional
                                   : PunctualLight::Kind::point;
}

/// Says whether every number was within its limits.
bool read_light(const tinygltf::Light& source, const std::string& where, PunctualLight& light,
                const GltfReport& report) {
    bool in_range = source.intensity >= 0 && source.range >= 0;
    light.kind = kind_of(source.type);
    const auto channel = [&](std::size_t i) {
        const double factor = i < source.color.size() ? source.color[i] : 1;
        in_range = in_range && factor >= 0 && factor <= 1;
        return static_cast<float>(std::max(0.0, factor) * std::max(0.0, source.intensity));
    };
    light.intensity = {channel(0), channel(1), channel(2)};
    constexpr float brightest = 1e18F;
    if (!(max_component(light.intensity) <= brightest))
        report.fail(where, fmt::format("an intensity of at most {:g}", brightest),
                    fmt::format("{:g}", source.intensity), "make the light weaker");
    light.range = static_cast<float>(std::clamp(source.range, 0.0, 1e18));
    if (light.kind != PunctualLight::Kind::spot) return in_range;
    constexpr double widest = std::numbers::pi / 2;
    const double outer = std::clamp(source.spot.outerConeAngle, 1e-4, widest);
    const double inner = std::clamp(source.spot.innerConeAngle, 0.0, outer);
    light.cos_outer = static_cast<float>(std::cos(outer));
    light.cos_inner = static_cast<float>(std::cos(inner));
    constexpr double rounding = 1e-6;
    return in_range && std::abs(outer - source.spot.outerConeAngle) < rounding && inner == source.spot.innerConeAngle;
}

}  // namespace

std::vector<PunctualLight> read_gltf_lights(const GltfDocument& document, const std::vector<GltfPlacement>& placements,
                                            const SceneFrame& frame, const GltfReport& report) {
    std::vector<PunctualLight> result;
    std::size_t out_of_range = 0, unusable = 0;
    for (const GltfPlacement& placement : placements) {
        const auto index = static_cast<std::size_t>(placement.object);
        PunctualLight light;
        out_of_range += !read_light(document.model.lights[index],
                                    fmt::format("extensions.KHR_lights_punctual.lights[{}]", index), light, report);
        const auto& rows = placement.to_world.rows;
        light.position = frame.to_local(placement.to_world.exact_point({0, 0, 0})).rounded();
        const double size = std::hypot(rows[0][2], rows[1][2], rows[2][2]);
        const auto along = [&](std::size_t r) { return static_cast<float>(-rows[r][2] / size); };
        light.direction = {along(0), along(1), along(2)};
        const bool aims = light.kind == PunctualLight::Kind::point || is_finite(light.direction);
        const bool placed = light.kind == PunctualLight::Kind::directional || is_usable_position(light.position);
        if (light.kind != PunctualLight::Kind::directional) {  // light falls off with the square of units
            light.intensity = (Vec3d(light.intensity) * (1 / (frame.unit * frame.unit))).rounded();
            light.range = static_cast<float>(double{light.range} / frame.unit);
        }
        if (!aims || !placed) {
            ++unusable;
            continue;
        }
        result.push_back(light);
    }
    if (out_of_range > 0)
        report.warning(
            fmt::format("{} punctual lights have a colour, intensity, range or cone out of its limits; the "
                        "nearest values in them are used",
                        out_of_range));
    if (unusable > 0)
        report.warning(fmt::format("skipped {} punctual lights without a place or a direction", unusable));
    return result;
}

}  // namespace raycache::tracer
