// Layout `bvh2-treelets`: the nodes and triangles of `bvh2`, the nodes treelet by treelet: connected parts of the tree
// that fit into a piece of a cache (T. Aila, T. Karras: Architecture Considerations for Tracing Incoherent Rays, HPG
// 2010), here of 2 KiB.
#pragma once

#include "tracer/bvh/layouts/bvh2.hpp"
#include "tracer/bvh/layouts/node_order.hpp"

namespace raycache::tracer {

struct Bvh2Treelets : Bvh2InOrder<treelets> {
    static constexpr const char* name = "bvh2-treelets";
    static constexpr const char* description =
        "as bvh2, with the nodes in connected treelets of 2 KiB (Aila & Karras 2010)";
};

}  // namespace raycache::tracer
