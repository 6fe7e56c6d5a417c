// How far ambient occlusion looks: a parameter that integrators have in common.
#pragma once

#include "tracer/paths/path_settings.hpp"
#include "tracer/sampling/parameters.hpp"
#include "tracer/scene/scene.hpp"

namespace raycache::tracer {

inline constexpr ParameterEntry radius_parameter{
    .name = "radius",
    .description =
        "how far what is in the way of ambient light may be, in metres, or 'auto': a 20th of the diagonal of "
        "the scene's bounding box",
    .fallback = "auto",
    .label = "the radius",
    .remedy = "give --radius such as 0.5",
    .most = 1e18,
    .word = "auto",
    .topic = "ambient occlusion"};

/// In metres.
inline float radius_of(const Scene& scene, const PathSettings& settings) {
    if (!settings.parameters.is_word(radius_parameter))
        return static_cast<float>(settings.parameters.real(radius_parameter));
    const Box box = scene.bounds();
    return length(box.upper - box.lower) / 20;
}

}  // namespace raycache::tracer
