// A triangle as layouts keep it: 48 bytes, one 16-byte load per axis, with the index of the triangle in the scene in
// what the first leaves free.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "tracer/scene/scene.hpp"
#include "tracer/vec.hpp"
#include "traces/header.hpp"

namespace raycache::tracer {

struct alignas(16) LeafTriangle {
    float x[3];              ///< of the three vertices
    std::uint32_t triangle;  ///< index in the scene
    float y[3];
    std::uint32_t alpha;  ///< 1 if its material may have holes
    float z[3];
    std::uint32_t unused;

    Vec3 vertex(int i) const { return {x[i], y[i], z[i]}; }
};
static_assert(sizeof(LeafTriangle) == 48);

/// These triangles of the scene, in this order.
std::vector<LeafTriangle> leaf_triangles(std::span<const std::uint32_t> order, const Scene&);

/// The region of a trace that holds `count` leaf triangles.
traces::Region leaf_triangle_region(std::size_t count);

}  // namespace raycache::tracer
