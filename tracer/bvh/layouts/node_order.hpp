// In which order a layout keeps the nodes of a tree: indices of its inner nodes in Bvh::nodes, the root first. None
// where the whole tree is a leaf.
#pragma once

#include <cstdint>
#include <vector>

#include "tracer/bvh/bvh.hpp"

namespace raycache::tracer {

/// Each node right before all below its first child, these before all below its second.
std::vector<std::uint32_t> depth_first(const Bvh&);
/// Level by level from the root, the nodes of a level from left to right.
std::vector<std::uint32_t> breadth_first(const Bvh&);
/// The upper half of the levels, then each subtree below from left to right; each part in the same way.
std::vector<std::uint32_t> van_emde_boas(const Bvh&);
/// Treelet by treelet. One grows from its root by the node of the largest surface below it, which rays are most likely
/// to go on to, until it has 32; the nodes then below it are roots of the next, the largest first.
std::vector<std::uint32_t> treelets(const Bvh&);

}  // namespace raycache::tracer
