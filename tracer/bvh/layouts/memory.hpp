// The bytes of a BVH as a traversal reads them, for programs that walk it by other means.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "tracer/bvh/layouts/layout.hpp"

namespace raycache::tracer {

struct LayoutMemory {
    /// Name of the layout whose nodes these are: `bvh2` also of layouts that only keep its nodes in another order.
    std::string tree;
    std::uint32_t node_bytes, triangle_bytes;        ///< of one
    std::span<const std::uint8_t> nodes, triangles;  ///< valid as long as the layout
};

/// Throws Error for a layout that list.hpp lacks.
LayoutMemory layout_memory(const BvhLayout&);

}  // namespace raycache::tracer
