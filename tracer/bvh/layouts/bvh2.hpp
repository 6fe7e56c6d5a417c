// Layout `bvh2`: what a GPU path tracer of the Aila–Laine kind keeps in memory (T. Aila, S. Laine: Understanding the
// Efficiency of Ray Traversal on GPUs, HPG 2009). A node of 64 B holds the boxes of both children, so one visit decides
// about two boxes; a triangle of 48 B holds its three vertices. Nodes stand in depth-first order, triangles in leaf
// order.
#pragma once

#include <cstdint>
#include <vector>

#include "tracer/bvh/bvh.hpp"
#include "traces/header.hpp"

namespace raycache::tracer {

/// Names a child: an inner node, a run of triangles, or nothing.
struct ChildRef {
    static constexpr std::uint32_t leaf_bit = 0x80000000U;
    static constexpr std::uint32_t nothing = leaf_bit;
    static constexpr std::uint32_t max_first = (1U << 28) - 1;

    static std::uint32_t leaf(std::uint32_t first, std::uint32_t count) { return leaf_bit | (first << 3) | count; }
    static bool is_leaf(std::uint32_t ref) { return (ref & leaf_bit) != 0; }
    static std::uint32_t first(std::uint32_t ref) { return (ref & ~leaf_bit) >> 3; }
    static std::uint32_t count(std::uint32_t ref) { return ref & 7; }
};

/// Per axis: lower plane of child 0, of child 1, upper plane of child 0, of child 1. An absent child has lower > upper.
struct alignas(64) Bvh2Node {
    float x[4], y[4], z[4];
    std::uint32_t child[2];
    std::uint32_t unused[2];
};
static_assert(sizeof(Bvh2Node) == 64);

struct alignas(16) Bvh2Triangle {
    Vec3 v0;
    std::uint32_t triangle;  ///< index in the scene
    Vec3 v1;
    std::uint32_t alpha;  ///< 1 if its material may have holes
    Vec3 v2;
    std::uint32_t unused;
};
static_assert(sizeof(Bvh2Triangle) == 48);

struct Bvh2 {
    std::vector<Bvh2Node> nodes;  ///< node 0 is the root
    std::vector<Bvh2Triangle> triangles;
    std::uint32_t stack_entries = 0;  ///< that a depth-first traversal can need
};

/// Throws Error where the tree is too large or too deep for the layout (2^28 triangles, 96 levels).
Bvh2 make_bvh2(const Bvh&, const Scene&);

/// Regions of the trace: 0 = nodes (with links to children), 1 = triangles.
inline constexpr std::uint8_t node_region = 0, triangle_region = 1, texel_region = 2;
std::vector<traces::Region> bvh2_regions(const Bvh2&);

}  // namespace raycache::tracer
