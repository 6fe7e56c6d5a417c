// From numbers in [0, 1) to directions.
#pragma once

#include <cmath>
#include <numbers>

#include "tracer/vec.hpp"

namespace raycache::tracer {

/// Turns `local` (z = normal) into world space by the orthonormal basis of T. Duff et al., "Building an Orthonormal
/// Basis, Revisited", JCGT 2017. The basis changes smoothly with the normal, so neighbouring pixels with equal numbers
/// send rays in nearly equal directions.
inline Vec3 to_world(Vec3 local, Vec3 normal) {
    const float sign = std::copysign(1.0F, normal.z);
    const float a = -1.0F / (sign + normal.z);
    const float b = normal.x * normal.y * a;
    const Vec3 tangent{1.0F + sign * normal.x * normal.x * a, sign * b, -sign * normal.x};
    const Vec3 bitangent{b, sign + normal.y * normal.y * a, -normal.y};
    return tangent * local.x + bitangent * local.y + normal * local.z;
}

/// Cosine-distributed around z: density cos(theta) / pi.
inline Vec3 cosine_hemisphere(Vec2 random) {
    const float radius = std::sqrt(random.x);
    const float phi = 2 * std::numbers::pi_v<float> * random.y;
    return {radius * std::cos(phi), radius * std::sin(phi), std::sqrt(std::fmax(0.0F, 1 - random.x))};
}

}  // namespace raycache::tracer
