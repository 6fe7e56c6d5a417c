// Watertight ray–triangle intersection: S. Woop, C. Benthin, I. Wald, JCGT 2013. Shear the triangle so that the ray
// runs along one axis, then decide by the signs of three 2-D edge functions; where one is exactly zero, decide in
// double. Two triangles that share an edge compute the same number for it, so no ray slips between them.
#pragma once

#include <cmath>
#include <utility>

#include "tracer/bvh/layouts/leaf_triangle.hpp"
#include "tracer/ray.hpp"

namespace raycache::tracer {

/// A ray prepared for triangle tests.
struct ShearedRay {
    float origin[3];
    int kx, ky, kz;    ///< kz: axis along which the direction is largest
    float sx, sy, sz;  ///< shear constants
    float t_min;

    void set(const Ray& ray) {
        origin[0] = ray.origin.x;
        origin[1] = ray.origin.y;
        origin[2] = ray.origin.z;
        const Vec3 size{std::fabs(ray.direction.x), std::fabs(ray.direction.y), std::fabs(ray.direction.z)};
        kz = size.x > size.y ? (size.x > size.z ? 0 : 2) : (size.y > size.z ? 1 : 2);
        kx = (kz + 1) % 3;
        ky = (kx + 1) % 3;
        if (ray.direction[kz] < 0) std::swap(kx, ky);
        sz = 1.0F / ray.direction[kz];
        sx = ray.direction[kx] * sz;
        sy = ray.direction[ky] * sz;
        t_min = ray.t_min;
    }
};

/// Writes t, u, v and returns true if the ray meets the triangle at t in (t_min, best], where `best` is `hit` as it
/// was: equal distances go to the lower triangle index, whatever the order of the visits. Leaves `hit` alone otherwise.
/// Both sides count.
inline bool test_triangle(const LeafTriangle& triangle, const ShearedRay& ray, Hit& hit) {
    const float* v0 = &triangle.v0.x;
    const float* v1 = &triangle.v1.x;
    const float* v2 = &triangle.v2.x;
    const int kx = ray.kx, ky = ray.ky, kz = ray.kz;
    const float az = v0[kz] - ray.origin[kz], bz = v1[kz] - ray.origin[kz], cz = v2[kz] - ray.origin[kz];
    const float ax = (v0[kx] - ray.origin[kx]) - ray.sx * az, ay = (v0[ky] - ray.origin[ky]) - ray.sy * az;
    const float bx = (v1[kx] - ray.origin[kx]) - ray.sx * bz, by = (v1[ky] - ray.origin[ky]) - ray.sy * bz;
    const float cx = (v2[kx] - ray.origin[kx]) - ray.sx * cz, cy = (v2[ky] - ray.origin[ky]) - ray.sy * cz;

    float e0 = cx * by - cy * bx;  // weight of v0
    float e1 = ax * cy - ay * cx;
    float e2 = bx * ay - by * ax;
    if (e0 == 0 || e1 == 0 || e2 == 0) {
        e0 = static_cast<float>(double{cx} * double{by} - double{cy} * double{bx});
        e1 = static_cast<float>(double{ax} * double{cy} - double{ay} * double{cx});
        e2 = static_cast<float>(double{bx} * double{ay} - double{by} * double{ax});
    }
    if ((e0 < 0 || e1 < 0 || e2 < 0) && (e0 > 0 || e1 > 0 || e2 > 0)) return false;
    const float determinant = e0 + e1 + e2;
    if (determinant == 0) return false;

    const float t = (e0 * (ray.sz * az) + e1 * (ray.sz * bz) + e2 * (ray.sz * cz)) / determinant;
    if (!(t > ray.t_min && t <= hit.t)) return false;
    if (t == hit.t && triangle.triangle >= hit.triangle) return false;
    hit = {t, e1 / determinant, e2 / determinant, triangle.triangle};
    return true;
}

}  // namespace raycache::tracer
