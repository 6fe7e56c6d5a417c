#include "tracer/bvh/layouts/bvh4.hpp"

#include <fmt/format.h>

#include "tracer/bvh/wide_tree.hpp"
#include "traces/error.hpp"

namespace raycache::tracer {

static_assert(WalkableBvh<Bvh4>);

std::unique_ptr<Bvh4> Bvh4::make(const Bvh& bvh, const Scene& scene) {
    if (bvh.triangles.size() > ChildRef::max_first)
        throw Error(fmt::format("{}: a BVH of {} triangle references; layout bvh4 holds {}", scene.name,
                                bvh.triangles.size(), ChildRef::max_first));
    const WideTree tree = collapse(bvh, 4, max_leaf_size);
    auto out = std::make_unique<Bvh4>();
    out->depth = tree.depth;
    out->nodes.reserve(tree.nodes.size());
    for (const WideTree::Node& node : tree.nodes) {
        Bvh4Node& made = out->nodes.emplace_back();
        for (std::uint32_t c = 0; c < 4; ++c) {
            const bool absent = c >= node.count;
            const WideTree::Child& child = tree.children[node.first + (absent ? 0 : c)];
            const Box box = absent ? Box{} : bvh.nodes[child.node].box;
            for (int axis = 0; axis < 3; ++axis) {
                made.lower[axis][c] = box.lower[axis];
                made.upper[axis][c] = box.upper[axis];
            }
            made.child[c] = absent            ? ChildRef::nothing
                            : child.is_leaf() ? ChildRef::leaf(child.first, child.count)
                                              : child.inner;
        }
    }
    out->triangles = leaf_triangles(bvh.triangles, scene);
    return out;
}

std::vector<traces::Region> Bvh4::regions() const {
    traces::Region region = node_region_of(nodes.size(), sizeof(Bvh4Node), 4);
    for (const Bvh4Node& node : nodes)
        for (const std::uint32_t ref : node.child) region.links.push_back(link_of(ref));
    return {std::move(region), leaf_triangle_region(triangles.size())};
}

}  // namespace raycache::tracer
