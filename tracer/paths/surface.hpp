// A hit, ready for shading.
#pragma once

#include "tracer/ray.hpp"
#include "tracer/scene/scene.hpp"

namespace raycache::tracer {

struct Surface {
    Vec3 position;
    Vec3 geometric_normal;  ///< unit, on the side the ray came from
    Vec3 shading_normal;    ///< unit, interpolated where the scene has normals, on the same side
    const Material* material = nullptr;
    bool back = false;       ///< the ray came from behind: triangles are counter-clockwise from their front
    float offset_scale = 1;  ///< Scene::offset_scale

    /// Where a ray that leaves to the side of `direction` starts: moved off the surface by a few ulps of its position
    /// or, near the origin, a fixed distance in proportion to the scene
    /// (C. Wächter, N. Binder: A Fast and Robust Method for Avoiding Self-Intersection, Ray Tracing Gems 2019, ch. 6).
    Vec3 leave(Vec3 direction) const;
};

Surface surface_at(const Scene&, const Ray&, const Hit&);

}  // namespace raycache::tracer
