#include "tracer/bvh/layouts/bvh2.hpp"

#include <fmt/format.h>

#include "tracer/bvh/layouts/node_order.hpp"
#include "traces/error.hpp"
#include "traces/symbols.hpp"

namespace raycache::tracer {
namespace {

static_assert(WalkableBvh<Bvh2>);

constexpr std::uint32_t max_depth = 96;

void set_box(Bvh2Node& node, int child, const Box& box) {
    node.x[child] = box.lower.x;
    node.y[child] = box.lower.y;
    node.z[child] = box.lower.z;
    node.x[child + 2] = box.upper.x;
    node.y[child + 2] = box.upper.y;
    node.z[child + 2] = box.upper.z;
}

}  // namespace

std::unique_ptr<Bvh2> make_bvh2(const Bvh& bvh, const Scene& scene, const std::vector<std::uint32_t>& order) {
    if (bvh.triangles.size() > ChildRef::max_first || bvh.depth > max_depth)
        throw Error(fmt::format("{}: a BVH of {} triangle references and {} levels; layout bvh2 holds {} and {}",
                                scene.name, bvh.triangles.size(), bvh.depth, ChildRef::max_first, max_depth));
    auto out = std::make_unique<Bvh2>();
    std::vector<std::uint32_t> ref_of(bvh.nodes.size());  // of a tree node
    for (std::size_t i = 0; i < bvh.nodes.size(); ++i)
        if (bvh.nodes[i].is_leaf()) ref_of[i] = ChildRef::leaf(bvh.nodes[i].first, bvh.nodes[i].count);
    for (std::uint32_t i = 0; i < order.size(); ++i) ref_of[order[i]] = i;

    out->nodes.reserve(order.size() + 1);
    for (const std::uint32_t i : order) {
        Bvh2Node& made = out->nodes.emplace_back();
        const std::size_t children[2] = {std::size_t{i} + 1, bvh.nodes[i].first};
        for (int c = 0; c < 2; ++c) {
            set_box(made, c, bvh.nodes[children[c]].box);
            made.child[c] = ref_of[children[c]];
        }
    }
    if (out->nodes.empty()) {  // the whole scene is one leaf: a root with one child
        Bvh2Node& root = out->nodes.emplace_back();
        set_box(root, 0, bvh.nodes[0].box);
        set_box(root, 1, Box{});
        root.child[0] = ref_of[0];
        root.child[1] = ChildRef::nothing;
    }
    out->triangles = leaf_triangles(bvh.triangles, scene);
    out->siblings = bvh.depth + 1;
    return out;
}

std::unique_ptr<Bvh2> Bvh2::make(const Bvh& bvh, const Scene& scene) { return make_bvh2(bvh, scene, depth_first(bvh)); }

std::vector<traces::Region> Bvh2::regions() const {
    traces::Region region = node_region_of(nodes.size(), sizeof(Bvh2Node), 2);
    for (const Bvh2Node& node : nodes)
        for (const std::uint32_t ref : node.child) region.links.push_back(link_of(ref));
    return {std::move(region), leaf_triangle_region(triangles.size())};
}

bool Bvh2::symbols_known() const {
    return siblings <= traces::symbol_stack_entries && nodes.front().child[1] != ChildRef::nothing;
}

}  // namespace raycache::tracer
