// How nodes of full precision name their children, and the region of a trace that such nodes are.
#pragma once

#include <cstddef>
#include <cstdint>

#include "traces/header.hpp"

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

/// Nodes of `bytes` each, without their links: `degree` for each node, to be added.
traces::Region node_region_of(std::size_t count, std::uint32_t bytes, std::uint8_t degree);

/// To elements of region 0, nodes, and region 1, triangles.
std::uint32_t node_link(std::uint32_t element);
std::uint32_t triangle_link(std::uint32_t element);
/// Of a ChildRef.
std::uint32_t link_of(std::uint32_t ref);

}  // namespace raycache::tracer
