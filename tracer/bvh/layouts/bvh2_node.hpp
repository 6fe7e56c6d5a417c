// A node of layout `bvh2`: 64 bytes with the boxes of both children, so that one visit decides about two boxes.
#pragma once

#include <cstdint>

#include "tracer/vec.hpp"

namespace raycache::tracer {

/// Names a child: an inner node, a run of triangles, or nothing.
struct ChildRef {
    static constexpr std::uint32_t leaf_bit = 0x80000000U;
    static constexpr std::uint32_t nothing = leaf_bit;
    static constexpr std::uint32_t max_first = (1U << 28) - 1;
    /// Added to a run: that without its first triangle.
    static constexpr std::uint32_t next_triangle = (1U << 3) - 1;

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

}  // namespace raycache::tracer
