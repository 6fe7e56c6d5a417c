// A triangle as layouts keep it: 48 bytes, three vertices in three 16-byte loads, with the index of the triangle in the
// scene in what the first vertex leaves free.
#pragma once

#include <cstdint>
#include <vector>

#include "tracer/bvh/bvh.hpp"
#include "tracer/scene/scene.hpp"
#include "tracer/vec.hpp"
#include "traces/header.hpp"

namespace raycache::tracer {

struct alignas(16) LeafTriangle {
    Vec3 v0;
    std::uint32_t triangle;  ///< index in the scene
    Vec3 v1;
    std::uint32_t alpha;  ///< 1 if its material may have holes
    Vec3 v2;
    std::uint32_t unused;
};
static_assert(sizeof(LeafTriangle) == 48);

/// Those of the tree, leaf by leaf.
std::vector<LeafTriangle> leaf_triangles(const Bvh&, const Scene&);

/// So many of them as a region of a trace.
traces::Region leaf_triangle_region(std::size_t count);

}  // namespace raycache::tracer
