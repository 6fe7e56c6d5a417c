#include "tracer/scene/gltf_sides.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace raycache::tracer {

namespace {

Vec3 area_vector(const Scene& scene, std::size_t triangle, Vec3& corner) {
    const std::uint32_t* index = &scene.indices[3 * triangle];
    corner = scene.positions[index[0]];
    return cross(scene.positions[index[1]] - corner, scene.positions[index[2]] - corner);
}

bool shows_back(const Scene& scene, Vec3 corner, Vec3 normal) {
    return std::any_of(scene.cameras.begin(), scene.cameras.end(), [&](const Camera& camera) {
        const Vec3 way = corner - camera.eye;
        const float ahead = dot(way, camera.forward);
        if (!(ahead > 0) || !(dot(normal, way) > 0)) return false;
        constexpr float widest_picture = 2;  // width over height
        const float half = std::tan(camera.vertical_fov * std::numbers::pi_v<float> / 360);
        return std::abs(dot(way, camera.up)) <= half * ahead &&
               std::abs(dot(way, cross(camera.forward, camera.up))) <= widest_picture * half * ahead;
    });
}

}  // namespace

std::uint64_t count_open_back_faces(const Scene& scene, const std::vector<GltfPlacement>& placements,
                                    const std::vector<std::vector<GltfPrimitive>>& meshes,
                                    const std::vector<bool>& double_sided) {
    if (std::all_of(double_sided.begin(), double_sided.end(), [](bool both) { return both; })) return 0;
    std::uint64_t triangles = 0;
    for (const GltfPlacement& placement : placements)
        for (const GltfPrimitive& primitive : meshes[static_cast<std::size_t>(placement.object)])
            triangles += primitive.indices.size() / 3;
    if (triangles != scene.triangle_count()) return 0;  // some were left out: what belongs to which mesh is not known

    std::uint64_t count = 0;
    std::size_t first = 0;
    Vec3 corner;
    for (const GltfPlacement& placement : placements) {
        std::size_t end = first;
        for (const GltfPrimitive& primitive : meshes[static_cast<std::size_t>(placement.object)])
            end += primitive.indices.size() / 3;
        double sum[3] = {}, area = 0;
        for (std::size_t t = first; t < end; ++t) {
            if (double_sided[scene.material_of[t]]) continue;
            const Vec3 vector = area_vector(scene, t, corner);
            for (int k = 0; k < 3; ++k) sum[k] += double{vector[k]};
            area += double{length(vector)};
        }
        constexpr double open_above = 1e-3;
        const bool open = std::hypot(sum[0], sum[1], sum[2]) > open_above * area;
        for (std::size_t t = first; open && t < end; ++t) {
            if (double_sided[scene.material_of[t]]) continue;
            const Vec3 normal = area_vector(scene, t, corner);
            count += shows_back(scene, corner, normal);
        }
        first = end;
    }
    return count;
}

}  // namespace raycache::tracer
