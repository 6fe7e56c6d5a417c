// Layout `bvh2`: what a GPU path tracer of the Aila–Laine kind keeps in memory (T. Aila, S. Laine: Understanding the
// Efficiency of Ray Traversal on GPUs, HPG 2009). A node of 64 B holds the boxes of both children; a triangle of 48 B
// its three vertices. Nodes stand in depth-first order, triangles in leaf order.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "tracer/bvh/layouts/bvh2_lane.hpp"
#include "tracer/bvh/layouts/bvh2_node.hpp"
#include "tracer/bvh/layouts/layout.hpp"
#include "tracer/bvh/layouts/leaf_triangle.hpp"

namespace raycache::tracer {

struct Bvh2 final : BvhLayout {
    static constexpr const char* name = "bvh2";
    static constexpr const char* description =
        "binary nodes of 64 B with both children's boxes, triangles of 48 B (Aila & Laine 2009)";
    static constexpr std::uint32_t max_leaf_size = 7;
    using Tree = Bvh2;
    static std::unique_ptr<Bvh2> make(const Bvh&, const Scene&);

    /// Regions of the trace: 0 = nodes (with links to children), 1 = triangles.
    static constexpr std::uint8_t node_region = 0, triangle_region = 1, region_count = 2;
    static constexpr std::array node_reads{node_region}, triangle_reads{triangle_region};
    std::vector<traces::Region> regions() const override;

    /// Symbols speak of trees up to some depth, and of roots with two children.
    bool symbols_known() const override;

    using View = Bvh2View;
    using Lane = Bvh2Lane;
    View view() const { return {nodes.data(), triangles.data()}; }
    std::size_t stack_entries() const { return siblings + Lane::more_stack_entries; }

    std::vector<Bvh2Node> nodes;  ///< node 0 is the root
    std::vector<LeafTriangle> triangles;
    std::uint32_t siblings = 0;  ///< that a lane can leave on its way
};

/// `order`: see node_order.hpp. Throws Error where the tree is too large or too deep for the layout (2^28 triangles, 96
/// levels).
std::unique_ptr<Bvh2> make_bvh2(const Bvh&, const Scene&, const std::vector<std::uint32_t>& order);

/// What a layout has that keeps its nodes in another order and is `bvh2` in all else.
template <std::vector<std::uint32_t> (*order)(const Bvh&)>
struct Bvh2InOrder {
    static constexpr std::uint32_t max_leaf_size = Bvh2::max_leaf_size;
    using Tree = Bvh2;
    static std::unique_ptr<Bvh2> make(const Bvh& bvh, const Scene& scene) { return make_bvh2(bvh, scene, order(bvh)); }
};

}  // namespace raycache::tracer
