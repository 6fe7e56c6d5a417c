// Hits so near to a ray's start, for the size of their triangle, that float does not tell on which side of the start
// they lie. A ray that leaves a wide triangle would meet it again.
#pragma once

#include "tracer/vec_double.hpp"

namespace raycache::tracer {

/// Hits nearer than this share of the distance to the triangle's farthest vertex are decided in double: float's error
/// is 2^-24 of that distance times a few operations, over the sine of the angle to the triangle: enough down to 1e-3.
inline constexpr float near_share = 0x1p-8F;

/// Where a ray from `origin` meets the plane of a triangle, in units of `direction`; NaN where it has none. Differences
/// of floats are exact but for a double's rounding.
inline double plane_distance(Vec3d a, Vec3d b, Vec3d c, Vec3d origin, Vec3d direction) {
    const Vec3d normal = cross(b - a, c - a);
    return dot(normal, a - origin) / dot(normal, direction);
}

}  // namespace raycache::tracer
