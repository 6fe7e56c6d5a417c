// How deep in the BVH an element of a trace lies, from the links of its regions.
//
// Depth = links followed from the root, which is element 0 of region 0, by the shortest way. A node links to its
// children, and to the first triangle of a leaf; a triangle that nothing links to belongs to the leaf of the triangle
// before it and is as deep. So the root has depth 0, and the triangles of a leaf lie one below the node that holds the
// leaf's box. What the root does not lead to, such as texels, has no depth.
#pragma once

#include <cstdint>
#include <vector>

#include "traces/header.hpp"

namespace raycache::cachesim {

class ElementDepth {
public:
    /// One byte an element of the regions that links lead to.
    explicit ElementDepth(const std::vector<traces::Region>& regions);

    static constexpr std::uint8_t none = 255;
    /// Deeper elements count as this deep.
    static constexpr std::uint8_t deepest = 254;

    /// Whether the root leads anywhere.
    bool known() const { return known_; }

    /// The element must exist. `none` if it has no depth.
    std::uint8_t operator()(std::size_t region, std::uint32_t element) const {
        return region < depths_.size() && !depths_[region].empty() ? depths_[region][element] : none;
    }

private:
    std::vector<std::vector<std::uint8_t>> depths_;  ///< by region, then element; empty: none there has a depth
    bool known_ = false;
};

}  // namespace raycache::cachesim
