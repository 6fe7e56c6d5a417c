// A bounding volume hierarchy as the builder leaves it: no byte layout yet. layouts/ turns it into what a GPU would
// read.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "tracer/scene/scene.hpp"
#include "tracer/vec.hpp"

namespace raycache::tracer {

/// A binary tree in depth-first order: node 0 is the root, an inner node's first child stands right behind it.
struct Bvh {
    struct Node {
        Box box;
        std::uint32_t first = 0;  ///< leaf: first entry of `triangles`; inner: index of the second child
        std::uint32_t count = 0;  ///< triangles of a leaf, 1 … max_leaf_size; 0 for an inner node
        bool is_leaf() const { return count != 0; }
    };
    std::vector<Node> nodes;
    std::vector<std::uint32_t>
        triangles;            ///< scene triangle of each leaf entry; one may occur twice after spatial splits
    std::uint32_t depth = 0;  ///< edges on the longest way from the root to a leaf
};

struct BvhSettings {
    std::uint32_t max_leaf_size = 4;  ///< triangles, 1 … 7
    bool spatial_splits = false;  ///< Stich, Friedrich, Dietrich 2009: fewer overlaps, some triangles referenced twice
};

/// Builds with Embree's binned-SAH builder on one thread, so that equal scenes give equal trees. Throws Error where the
/// scene has no triangle or coordinates beyond 1e18.
Bvh build_bvh(const Scene&, const BvhSettings& = {});

/// Who builds, in words: equal ones build equal trees of equal triangles, on every processor.
std::string bvh_builder();

/// Entries of Bvh::triangles that build_bvh() can make of `triangles` triangles.
std::size_t most_leaf_entries(std::size_t triangles, const BvhSettings&);

}  // namespace raycache::tracer
