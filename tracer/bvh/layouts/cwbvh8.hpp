// Layout `cwbvh8`: the compressed wide BVH of H. Ylitie, T. Karras, S. Laine, Efficient Incoherent Ray Traversal on
// GPUs Through Compressed Wide BVHs, HPG 2017: nodes of 80 B with eight quantised boxes in the order of octants,
// triangles of 48 B, at most three to a leaf. Made of a binary tree with one triangle to a leaf (wide_tree.hpp).
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "tracer/bvh/layouts/cwbvh8_lane.hpp"
#include "tracer/bvh/layouts/layout.hpp"
#include "tracer/bvh/layouts/leaf_triangle.hpp"

namespace raycache::tracer {

struct Cwbvh8 final : BvhLayout {
    static constexpr const char* name = "cwbvh8";
    static constexpr const char* description =
        "nodes of 80 B with eight quantised boxes, triangles of 48 B (Ylitie, Karras & Laine 2017)";
    static constexpr std::uint32_t max_leaf_size = 1;
    using Tree = Cwbvh8;
    /// Throws Error where the tree is too large for the layout (2^28 triangles) or a leaf of it has more than three.
    static std::unique_ptr<Cwbvh8> make(const Bvh&, const Scene&);

    static constexpr std::uint8_t node_region = 0, triangle_region = 1, region_count = 2;
    static constexpr std::array node_reads{node_region}, triangle_reads{triangle_region};
    std::vector<traces::Region> regions() const override;
    bool symbols_known() const override { return false; }

    using View = Cwbvh8View;
    using Lane = Cwbvh8Lane;
    View view() const { return {nodes.data(), triangles.data()}; }
    /// One group is left at each level.
    std::size_t stack_entries() const { return std::size_t{depth} + 1; }

    std::vector<Cwbvh8Node> nodes;  ///< node 0 is the root
    std::vector<LeafTriangle> triangles;
    std::uint32_t depth = 0;  ///< nodes below the root on the longest way
};

}  // namespace raycache::tracer
