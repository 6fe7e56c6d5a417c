// A binary tree with inner nodes left out, so that those kept have more children: what wide layouts are made of.
//
// Which to leave out is decided as H. Ylitie, T. Karras and S. Laine do (Efficient Incoherent Ray Traversal on GPUs
// Through Compressed Wide BVHs, HPG 2017): dynamic programming finds the tree of the least surface area
// cost among all that arise from the binary one. A visit to a node and a test of a triangle cost the same, as they do
// where the binary tree is built (bvh.hpp).
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "tracer/bvh/bvh.hpp"

namespace raycache::tracer {

struct WideTree {
    struct Child {
        std::uint32_t node;      ///< of Bvh::nodes: whose box it has
        std::uint32_t inner;     ///< of `nodes`; only if count is 0
        std::uint32_t first;     ///< of Bvh::triangles; only of a leaf
        std::uint32_t count;     ///< triangles of a leaf, 0 of an inner node
        std::uint32_t slot = 0;  ///< its place in the node, if the layout arranges children

        bool is_leaf() const { return count != 0; }
    };
    struct Node {
        std::uint32_t node;   ///< of Bvh::nodes: whose box it has
        std::uint32_t first;  ///< of `children`
        std::uint32_t count;  ///< 1 only where the whole tree is a leaf
    };
    /// The root is node 0. Inner children of a node stand side by side, in the order of its children; then all below
    /// the first of them, all below the second …
    std::vector<Node> nodes;
    std::vector<Child> children;
    std::uint32_t depth = 0;  ///< nodes on the longest way from the root, the root not counted
};

/// May sort the children of the node, and gives them slots.
using ArrangeChildren = std::function<void(std::uint32_t node, std::vector<WideTree::Child>&)>;

inline constexpr unsigned most_children = 8;

/// `width`: children of a node at most, 2 … most_children. `max_leaf_size`: triangles of a leaf; those of the binary
/// tree must not have more.
WideTree collapse(const Bvh&, unsigned width, std::uint32_t max_leaf_size, const ArrangeChildren& arrange = {});

}  // namespace raycache::tracer
