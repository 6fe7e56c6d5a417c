// Where lanes of a warp begin a leaf of the BVH: what Timing::leaf_instructions are charged for.
//
// A node links to the first triangle of a leaf (traces/header.hpp), and the lanes of a warp that stand at leaves begin
// them together and test their triangles one behind the other. So a visit begins a leaf where a lane reads a triangle
// that a link leads to. Where no link leads to any triangle of a region, the trace does not name its leaves: there a
// visit begins one if the step of the warp before it was not to triangles (texels, for one, are no step); leaves that
// follow each other without a node between them then count as one.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "traces/header.hpp"

namespace raycache::cachesim {

class LeafStarts {
public:
    /// One bit for each element of the regions of triangles that links lead to.
    explicit LeafStarts(const std::vector<traces::Region>&);

    bool is_triangle(std::uint32_t region) const { return regions_[region].kind == traces::ObjectKind::triangle; }
    bool is_step(std::uint32_t region) const { return traces::role_of(regions_[region].kind).is_step; }

    /// Whether lanes that read these triangles of the region begin a leaf. `among_triangles`: the step before was to
    /// triangles, too.
    bool begins(std::uint32_t region, std::span<const std::uint32_t> triangles, bool among_triangles) const {
        const OfRegion& of = regions_[region];
        if (of.first.empty()) return !among_triangles;
        for (const std::uint32_t t : triangles)
            if (of.first[t / 64] >> (t % 64) & 1) return true;
        return false;
    }

private:
    struct OfRegion {
        traces::ObjectKind kind = traces::ObjectKind::node;
        std::vector<std::uint64_t> first;  ///< triangles: bit: a link leads there; empty: to none
    };
    std::vector<OfRegion> regions_;
};

}  // namespace raycache::cachesim
