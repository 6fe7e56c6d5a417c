// Layout `bvh4`: nodes of 128 B with the boxes of four children, so that one visit decides about four; triangles of
// 48 B. The binary tree collapsed (wide_tree.hpp), its leaves left as they are. Children that are hit are visited by
// the distance of their boxes; the stack holds no distances, as that of bvh2 does not.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "tracer/bvh/layouts/bvh4_lane.hpp"
#include "tracer/bvh/layouts/layout.hpp"
#include "tracer/bvh/layouts/leaf_triangle.hpp"

namespace raycache::tracer {

struct Bvh4 final : BvhLayout {
    static constexpr const char* name = "bvh4";
    static constexpr const char* description = "nodes of 128 B with the boxes of four children, triangles of 48 B";
    static constexpr std::uint32_t max_leaf_size = 7;
    using Tree = Bvh4;
    /// Throws Error where the tree is too large for the layout (2^28 triangles).
    static std::unique_ptr<Bvh4> make(const Bvh&, const Scene&);

    static constexpr std::uint8_t node_region = 0, triangle_region = 1, region_count = 2;
    static constexpr std::array node_reads{node_region}, triangle_reads{triangle_region};
    std::vector<traces::Region> regions() const override;
    bool symbols_known() const override { return false; }

    using View = Bvh4View;
    using Lane = Bvh4Lane;
    View view() const { return {nodes.data(), triangles.data()}; }
    /// Three siblings are left at each level; one entry more is the sentinel.
    std::size_t stack_entries() const { return 3 * (std::size_t{depth} + 1) + 1; }

    std::vector<Bvh4Node> nodes;  ///< node 0 is the root
    std::vector<LeafTriangle> triangles;
    std::uint32_t depth = 0;  ///< nodes below the root on the longest way
};

}  // namespace raycache::tracer
