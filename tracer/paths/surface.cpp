#include "tracer/paths/surface.hpp"

#include <algorithm>
#include <cmath>

namespace raycache::tracer {
namespace {

constexpr float rounding = 0x1p-24F;  // of one float operation, relative
constexpr float test_error = 32;

struct Corners {
    Vec3d a, b, c;
    /// The largest coordinate of a vertex as seen from `p`.
    double reach(Vec3d p) const { return std::max({max_abs(a - p), max_abs(b - p), max_abs(c - p)}); }
};

/// Where the ray meets the plane; at the barycentric weights of the hit where that is far from there, as it is for rays
/// almost in the plane.
Vec3d position_of(const Corners& corner, Vec3d normal, const Ray& ray, const Hit& hit) {
    constexpr double near = 0x1p-10;
    const double u{hit.u}, v{hit.v};
    const Vec3d weighted = corner.a * (1 - u - v) + corner.b * u + corner.c * v;
    const Vec3d origin(ray.origin), direction(ray.direction);
    const Vec3d met = origin + direction * (dot(normal, corner.a - origin) / dot(normal, direction));
    return max_abs(met - weighted) <= near * corner.reach(weighted) ? met : weighted;
}

}  // namespace

Vec3 Surface::leave(Vec3 direction) const {
    return position + geometric_normal * (dot(direction, geometric_normal) < 0 ? -clearance : clearance);
}

Surface surface_at(const Scene& scene, const Ray& ray, const Hit& hit) {
    const std::uint32_t* index = &scene.indices[3 * std::size_t{hit.triangle}];
    const Corners corner{scene.positions[index[0]], scene.positions[index[1]], scene.positions[index[2]]};
    const float w = 1 - hit.u - hit.v;
    Surface s;
    s.material = &scene.materials[scene.material_of[hit.triangle]];
    // In double: fourth powers of edges, which float holds from 1e-11 to 4e9 alone.
    const Vec3d normal = cross(corner.b - corner.a, corner.c - corner.a);
    const double size2 = dot(normal, normal);
    s.geometric_normal = (size2 > 0 ? normal * (1 / std::sqrt(size2)) : normal).rounded();
    const Vec3d position = position_of(corner, normal, ray, hit);
    s.position = position.rounded();
    const Vec3 n = s.geometric_normal, p = s.position;
    s.clearance = rounding * (2 * (std::fabs(n.x * p.x) + std::fabs(n.y * p.y) + std::fabs(n.z * p.z)) +
                              test_error * std::min(static_cast<float>(corner.reach(position)), scene.giant_above));
    s.back = dot(s.geometric_normal, ray.direction) > 0;
    if (s.back) s.geometric_normal = -s.geometric_normal;
    s.shading_normal = s.geometric_normal;
    if (!scene.normals.empty()) {
        const Vec3 blended =
            scene.normals[index[0]] * w + scene.normals[index[1]] * hit.u + scene.normals[index[2]] * hit.v;
        const float size = length(blended);
        if (size > 0.1F) {  // else (0,0,0): the file gives none, or they cancel
            s.shading_normal = blended / size;
            if (dot(s.shading_normal, s.geometric_normal) < 0) s.shading_normal = -s.shading_normal;
        }
    }
    return s;
}

}  // namespace raycache::tracer
