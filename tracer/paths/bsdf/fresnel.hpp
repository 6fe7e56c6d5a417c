// How much of the light a smooth boundary reflects.
#pragma once

#include <algorithm>
#include <cmath>

#include "tracer/vec.hpp"

namespace raycache::tracer {

/// (1 - cosine)^5, the angular part of C. Schlick, "An Inexpensive BRDF Model for Physically-based Rendering", Computer
/// Graphics Forum 13 (3), 1994: F = F0 + (1 - F0) (1 - cosine)^5.
inline float schlick_rise(float cosine) {
    const float c = std::clamp(1 - cosine, 0.0F, 1.0F);
    return c * c * c * c * c;
}

/// Reflectance of a dielectric head on. An index of 0 is glTF's "infinite": everything is reflected
/// (KHR_materials_ior).
inline float dielectric_f0(float ior) {
    if (ior == 0) return 1;
    const float root = (ior - 1) / (ior + 1);
    return root * root;
}

/// Fresnel's equations for unpolarised light that meets a boundary at `cosine` > 0. `eta`: index of the far side over
/// that of the near side. `cosine_far` becomes the cosine behind the boundary, 0 under total reflection (which gives
/// 1).
inline float dielectric_fresnel(float cosine, float eta, float& cosine_far) {
    const float sine2 = std::max(0.0F, 1 - cosine * cosine) / (eta * eta);
    cosine_far = 0;
    if (!(sine2 < 1)) return 1;
    if (eta == 1) {
        cosine_far = cosine;
        return 0;
    }
    cosine_far = std::sqrt(1 - sine2);
    const float parallel = (eta * cosine - cosine_far) / (eta * cosine + cosine_far);
    const float perpendicular = (cosine - eta * cosine_far) / (cosine + eta * cosine_far);
    return 0.5F * (parallel * parallel + perpendicular * perpendicular);
}

}  // namespace raycache::tracer
