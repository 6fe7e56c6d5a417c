#include "tracer/bvh/layouts/leaf_triangle.hpp"

namespace raycache::tracer {

std::vector<LeafTriangle> leaf_triangles(std::span<const std::uint32_t> order, const Scene& scene) {
    std::vector<LeafTriangle> triangles;
    triangles.reserve(order.size());
    for (const std::uint32_t t : order) {
        const std::uint32_t* index = &scene.indices[3 * std::size_t{t}];
        const Vec3 a = scene.positions[index[0]], b = scene.positions[index[1]], c = scene.positions[index[2]];
        const bool holes = scene.materials[scene.material_of[t]].may_have_holes();
        triangles.push_back({{a.x, b.x, c.x}, t, {a.y, b.y, c.y}, holes ? 1U : 0U, {a.z, b.z, c.z}, 0});
    }
    return triangles;
}

traces::Region leaf_triangle_region(std::size_t count) {
    traces::Region region;
    region.kind = traces::ObjectKind::triangle;
    region.base = 0x20'0000'0000;
    region.element_size = region.stride = sizeof(LeafTriangle);
    region.count = static_cast<std::uint32_t>(count);
    return region;
}

}  // namespace raycache::tracer
