// Layout `bvh2-van-emde-boas`: the nodes and triangles of `bvh2`, the nodes in the order of van Emde Boas: the upper
// half of the levels first, then each subtree below it, all of them laid out in the same way. A walk from the root then
// passes few blocks of any size (M. Frigo, C. Leiserson, H. Prokop, S. Ramachandran: Cache-Oblivious Algorithms, FOCS
// 1999).
#pragma once

#include "tracer/bvh/layouts/bvh2.hpp"
#include "tracer/bvh/layouts/node_order.hpp"

namespace raycache::tracer {

struct Bvh2VanEmdeBoas : Bvh2InOrder<van_emde_boas> {
    static constexpr const char* name = "bvh2-van-emde-boas";
    static constexpr const char* description =
        "as bvh2, with the nodes in the order of van Emde Boas: near on the way down, near in memory";
};

}  // namespace raycache::tracer
