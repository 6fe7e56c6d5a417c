// From the user's world to the floats that rays are traced in, and back.
#pragma once

#include "tracer/vec_double.hpp"

namespace raycache::tracer {

/// Where the tracer's coordinates lie in the world. Everything that a user gives or reads is in the world.
struct SceneFrame {
    Vec3d origin{};   ///< of the tracer's coordinates, metres in the world
    double unit = 1;  ///< metres in a unit of the tracer: a power of two, so that scaling rounds nothing

    Vec3d to_local(Vec3d world) const { return (world - origin) * (1 / unit); }
    Vec3d to_world(Vec3d local) const { return local * unit + origin; }
    bool operator==(const SceneFrame&) const = default;
};

}  // namespace raycache::tracer
