// One ray's way through a BVH: "while-while" of Aila & Laine 2009, the loop of tracer/simt/warp_traversal.hpp. Compiled
// for a GPU, 32 lanes go through it together and agree by votes how long each of the two inner loops lasts; compiled
// for a processor, a lane is alone. What a lane visits is the same.
#pragma once

#include "tools/gpu/walk_bvh2.hpp"
#include "tools/gpu/walk_bvh4.hpp"
#include "tools/gpu/walk_cwbvh8.hpp"

namespace raycache::gpu {

/// The triangles that each ray passes because there is a hole in them: those of ray r are entries firsts[r] …
/// firsts[r + 1] - 1.
struct HoleList {
    const std::uint32_t* firsts;
    const std::uint32_t* triangles;

    RAYCACHE_BOTH bool passes(std::uint64_t ray, std::uint32_t triangle) const {
        for (std::uint32_t i = firsts[ray]; i != firsts[ray + 1]; ++i)
            if (triangles[i] == triangle) return true;
        return false;
    }
};

/// What a launch reads. On a GPU all of it is device memory.
struct WalkInput {
    const void *nodes, *triangles;
    const PackedRay* rays;
    HoleList holes;
};

/// Elements that were read.
struct Visits {
    std::uint64_t nodes, triangles;
};

/// `Tree`: WalkBvh2, WalkBvh4 or WalkCwbvh8. `Warp::any(condition)`: whether it holds for any of the lanes that walk
/// together. Every one of these calls this, those without a ray with `active` false.
template <class Tree, class Warp>
RAYCACHE_BOTH Hit walk(const WalkInput& in, std::uint64_t number, bool active, bool any_hit, Visits& visits) {
    typename Tree::Entry stack[Tree::most_stack];
    const PackedRay ray = active ? load_ray(in.rays + number) : PackedRay{{0, 0, 0}, 0, {1, 1, 1}, 0};
    Hit hit{ray.t_max, no_triangle};
    ShearedRay sheared;
    sheared.set(ray);
    Tree lane;
    lane.start(ray, stack, active);
    bool blocked = false;
    while (Warp::any(lane.at_node() || lane.at_triangles())) {
        while (Warp::any(lane.at_node())) {
            if (!lane.at_node()) continue;
            ++visits.nodes;
            lane.visit_node(in.nodes, stack);
        }
        const bool at_triangles = lane.at_triangles();
        bool waiting = at_triangles;
        while (Warp::any(waiting)) {
            if (!waiting) continue;
            ++visits.triangles;
            const Triangle triangle = load_triangle(in.triangles, lane.take_triangle());
            waiting = lane.more_triangles();
            Hit met;
            if (!test_triangle(triangle, sheared, hit, met)) continue;
            if (triangle.holes && in.holes.passes(number, triangle.number)) continue;
            hit = met;
            lane.shorten(met.t);
            blocked = true;
            waiting = waiting && !any_hit;
        }
        if (!at_triangles) continue;
        if (any_hit && blocked)
            lane.end();
        else
            lane.leave_triangles(stack);
    }
    const float never = as_float(0x7f800000U);
    if (any_hit) return {blocked ? 0.0F : never, no_triangle};
    return hit.triangle == no_triangle ? Hit{never, no_triangle} : hit;
}

}  // namespace raycache::gpu
