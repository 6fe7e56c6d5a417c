#include "tracer/bvh/layouts/bvh2.hpp"

#include <fmt/format.h>

#include <limits>

#include "traces/error.hpp"

namespace raycache::tracer {
namespace {

constexpr std::uint32_t max_depth = 96;
constexpr std::uint64_t node_base = 0x10'0000'0000, triangle_base = 0x20'0000'0000;

void set_box(Bvh2Node& node, int child, const Box& box) {
    node.x[child] = box.lower.x;
    node.y[child] = box.lower.y;
    node.z[child] = box.lower.z;
    node.x[child + 2] = box.upper.x;
    node.y[child + 2] = box.upper.y;
    node.z[child + 2] = box.upper.z;
}

std::uint32_t to_link(std::uint32_t ref) {
    if (ref == ChildRef::nothing) return traces::no_link;
    if (ChildRef::is_leaf(ref)) return (std::uint32_t{triangle_region} << 30) | ChildRef::first(ref);
    return (std::uint32_t{node_region} << 30) | ref;
}

}  // namespace

Bvh2 make_bvh2(const Bvh& bvh, const Scene& scene) {
    if (bvh.triangles.size() > ChildRef::max_first || bvh.depth > max_depth)
        throw Error(fmt::format("{}: a BVH of {} triangle references and {} levels; layout bvh2 holds {} and {}",
                                scene.name, bvh.triangles.size(), bvh.depth, ChildRef::max_first, max_depth));
    Bvh2 out;
    // Inner nodes keep their depth-first order; new_index maps a tree node to its layout node.
    std::vector<std::uint32_t> new_index(bvh.nodes.size());
    std::uint32_t inner = 0;
    for (std::size_t i = 0; i < bvh.nodes.size(); ++i)
        new_index[i] = bvh.nodes[i].is_leaf() ? ChildRef::leaf(bvh.nodes[i].first, bvh.nodes[i].count) : inner++;

    out.nodes.reserve(inner + 1);
    for (std::size_t i = 0; i < bvh.nodes.size(); ++i) {
        const Bvh::Node& node = bvh.nodes[i];
        if (node.is_leaf()) continue;
        Bvh2Node& made = out.nodes.emplace_back();
        const std::size_t children[2] = {i + 1, node.first};
        for (int c = 0; c < 2; ++c) {
            set_box(made, c, bvh.nodes[children[c]].box);
            made.child[c] = new_index[children[c]];
        }
    }
    if (out.nodes.empty()) {  // the whole scene is one leaf: a root with one child
        Bvh2Node& root = out.nodes.emplace_back();
        set_box(root, 0, bvh.nodes[0].box);
        set_box(root, 1, Box{});
        root.child[0] = new_index[0];
        root.child[1] = ChildRef::nothing;
    }

    out.triangles.reserve(bvh.triangles.size());
    for (const std::uint32_t t : bvh.triangles) {
        const std::uint32_t* index = &scene.indices[3 * std::size_t{t}];
        out.triangles.push_back({scene.positions[index[0]], t, scene.positions[index[1]],
                                 scene.materials[scene.material_of[t]].may_have_holes() ? 1U : 0U,
                                 scene.positions[index[2]], 0});
    }
    out.stack_entries = bvh.depth + 1;
    return out;
}

std::vector<traces::Region> bvh2_regions(const Bvh2& bvh) {
    traces::Region nodes;
    nodes.kind = traces::ObjectKind::node;
    nodes.base = node_base;
    nodes.element_size = nodes.stride = sizeof(Bvh2Node);
    nodes.count = static_cast<std::uint32_t>(bvh.nodes.size());
    nodes.degree = 2;
    nodes.links.reserve(2 * bvh.nodes.size());
    for (const Bvh2Node& node : bvh.nodes)
        for (const std::uint32_t ref : node.child) nodes.links.push_back(to_link(ref));

    traces::Region triangles;
    triangles.kind = traces::ObjectKind::triangle;
    triangles.base = triangle_base;
    triangles.element_size = triangles.stride = sizeof(Bvh2Triangle);
    triangles.count = static_cast<std::uint32_t>(bvh.triangles.size());
    return {std::move(nodes), std::move(triangles)};
}

}  // namespace raycache::tracer
