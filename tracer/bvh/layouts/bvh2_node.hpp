// A node of layout `bvh2`: 64 bytes with the boxes of both children, so that one visit decides about two boxes.
#pragma once

#include <cstdint>

#include "tracer/bvh/layouts/child_ref.hpp"
#include "tracer/vec.hpp"

namespace raycache::tracer {

/// Per axis: lower plane of child 0, of child 1, upper plane of child 0, of child 1. An absent child has lower > upper.
struct alignas(64) Bvh2Node {
    float x[4], y[4], z[4];
    std::uint32_t child[2];
    std::uint32_t unused[2];
};
static_assert(sizeof(Bvh2Node) == 64);

}  // namespace raycache::tracer
