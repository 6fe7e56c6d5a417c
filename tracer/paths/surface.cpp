#include "tracer/paths/surface.hpp"

#include <bit>
#include <cmath>

namespace raycache::tracer {
namespace {

/// Constants of the cited chapter: below `near_zero` a fixed offset, else `ulps` steps of the float. Its unit is a
/// metre; `scale` makes it the scene's.
constexpr float near_zero = 1.0F / 32, fixed_offset = 1.0F / 65536, ulps = 256;

float step(float position, float normal, float scale) {
    if (std::fabs(position) < near_zero * scale) return position + fixed_offset * scale * normal;
    const auto steps = static_cast<std::int32_t>(ulps * normal);
    return std::bit_cast<float>(std::bit_cast<std::int32_t>(position) + (position < 0 ? -steps : steps));
}

}  // namespace

Vec3 Surface::leave(Vec3 direction) const {
    const Vec3 n = dot(direction, geometric_normal) < 0 ? -geometric_normal : geometric_normal;
    return {step(position.x, n.x, offset_scale), step(position.y, n.y, offset_scale),
            step(position.z, n.z, offset_scale)};
}

Surface surface_at(const Scene& scene, const Ray& ray, const Hit& hit) {
    const std::uint32_t* index = &scene.indices[3 * std::size_t{hit.triangle}];
    const Vec3 a = scene.positions[index[0]], b = scene.positions[index[1]], c = scene.positions[index[2]];
    const float w = 1 - hit.u - hit.v;
    Surface s;
    s.material = &scene.materials[scene.material_of[hit.triangle]];
    s.position = a * w + b * hit.u + c * hit.v;
    s.geometric_normal = normalize(cross(b - a, c - a));
    s.offset_scale = scene.offset_scale;
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
