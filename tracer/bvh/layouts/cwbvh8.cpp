#include "tracer/bvh/layouts/cwbvh8.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "tracer/bvh/layouts/child_ref.hpp"
#include "tracer/bvh/wide_tree.hpp"
#include "traces/error.hpp"

namespace raycache::tracer {
namespace {

static_assert(WalkableBvh<Cwbvh8>);

constexpr std::uint32_t most_triangles_of_a_leaf = 3;

Vec3 centre_of(const Box& box) { return box.lower * 0.5F + box.upper * 0.5F; }

void arrange(const Bvh& bvh, std::uint32_t node, std::vector<WideTree::Child>& children) {
    std::array<Vec3, most_children> centres;
    for (std::size_t c = 0; c < children.size(); ++c)
        centres[c] = centre_of(bvh.nodes[children[c].node].box) - centre_of(bvh.nodes[node].box);
    const auto slots = octant_slots(std::span(centres).first(children.size()));
    for (std::size_t c = 0; c < children.size(); ++c) children[c].slot = slots[c];
    std::sort(children.begin(), children.end(), [](const auto& a, const auto& b) { return a.slot < b.slot; });
}

}  // namespace

std::unique_ptr<Cwbvh8> Cwbvh8::make(const Bvh& bvh, const Scene& scene) {
    if (bvh.triangles.size() > ChildRef::max_first)
        throw Error(fmt::format("{}: a BVH of {} triangle references; layout cwbvh8 holds {}", scene.name,
                                bvh.triangles.size(), ChildRef::max_first));
    const WideTree tree = collapse(bvh, most_children, most_triangles_of_a_leaf,
                                   [&](std::uint32_t node, auto& children) { arrange(bvh, node, children); });
    auto out = std::make_unique<Cwbvh8>();
    out->depth = tree.depth;
    out->nodes.reserve(tree.nodes.size());
    std::vector<std::uint32_t> order;
    order.reserve(bvh.triangles.size());
    for (const WideTree::Node& node : tree.nodes) {
        Cwbvh8Node& made = out->nodes.emplace_back();
        made = {};
        made.first_triangle = static_cast<std::uint32_t>(order.size());
        std::array<Box, most_children> boxes;
        bool has_node = false;
        for (std::uint32_t c = 0; c < node.count; ++c) {
            const WideTree::Child& child = tree.children[node.first + c];
            boxes[child.slot] = bvh.nodes[child.node].box;
            if (child.is_leaf()) {
                const auto place = static_cast<std::uint32_t>(order.size()) - made.first_triangle;
                made.meta[child.slot] = static_cast<std::uint8_t>(((1U << child.count) - 1) << 5 | place);
                const auto first = bvh.triangles.begin() + child.first;
                order.insert(order.end(), first, first + child.count);
            } else {
                made.meta[child.slot] = static_cast<std::uint8_t>(1U << 5 | (Cwbvh8Node::first_inner + child.slot));
                made.inner |= static_cast<std::uint8_t>(1U << child.slot);
                if (!has_node) made.first_node = child.inner;
                has_node = true;
            }
        }
        quantise(bvh.nodes[node.node].box, boxes, made);
    }
    out->triangles = leaf_triangles(order, scene);
    return out;
}

std::vector<traces::Region> Cwbvh8::regions() const {
    traces::Region region = node_region_of(nodes.size(), sizeof(Cwbvh8Node), most_children);
    for (const Cwbvh8Node& node : nodes) {
        std::uint32_t next = node.first_node;
        for (const std::uint8_t meta : node.meta)
            region.links.push_back(meta == 0 ? traces::no_link
                                   : (meta & 31) >= Cwbvh8Node::first_inner
                                       ? node_link(next++)
                                       : triangle_link(node.first_triangle + (meta & 31)));
    }
    return {std::move(region), leaf_triangle_region(triangles.size())};
}

}  // namespace raycache::tracer
