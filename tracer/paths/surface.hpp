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
    bool back = false;    ///< the ray came from behind: triangles are counter-clockwise from their front
    float clearance = 0;  ///< that a leaving ray keeps from the surface

    /// Where a ray that leaves to the side of `direction` starts.
    Vec3 leave(Vec3 direction) const;
};

/// The position is where the ray meets the triangle's plane, in double: as exact as float can say, however wide the
/// triangle. So `clearance` is the sum of two bounds of what is rounded along the normal n
/// (as M. Pharr, W. Jakob, G. Humphreys: Physically Based Rendering, 4th ed., 6.8.6, for a point so computed):
///   the position p, and the leaving ray's start:    2 * 2^-24 (|n.x p.x| + |n.y p.y| + |n.z p.z|)
///   the next test of the same triangle, whose vertices are at most w away on an axis:    32 * 2^-24 w
/// Both tests (ray_triangle.hpp, Embree's) subtract the ray's origin from the vertices first, so that their error along
/// the normal grows with w, not with the coordinates; 32 leaves triangles 30 times as long as wide no second hit at any
/// angle (tests/tracer/leaving_rays.cpp). w is at most Scene::giant_above: wider triangles are tested in double.
Surface surface_at(const Scene&, const Ray&, const Hit&);

}  // namespace raycache::tracer
