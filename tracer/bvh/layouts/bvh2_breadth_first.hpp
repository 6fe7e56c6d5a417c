// Layout `bvh2-breadth-first`: the nodes and triangles of `bvh2`, the nodes level by level from the root. What a ray
// visits is the same; where it lies is not: the levels that all rays pass stand together, a node and its children
// apart.
#pragma once

#include "tracer/bvh/layouts/bvh2.hpp"
#include "tracer/bvh/layouts/node_order.hpp"

namespace raycache::tracer {

struct Bvh2BreadthFirst : Bvh2InOrder<breadth_first> {
    static constexpr const char* name = "bvh2-breadth-first";
    static constexpr const char* description = "as bvh2, with the nodes level by level from the root";
};

}  // namespace raycache::tracer
