// How a lane steps through nodes of layout `bvh2` (64 bytes, four loads), as tracer/bvh/layouts/bvh2_lane.hpp does.
#pragma once

#include "tools/gpu/walk_refs.hpp"

namespace raycache::gpu {

struct WalkBvh2 : RefLane {
    static constexpr const char* name = "bvh2";
    static constexpr std::uint32_t node_bytes = 64;
    /// One sibling at each of 97 levels, and the end.
    static constexpr std::uint32_t most_stack = 98;

    RAYCACHE_BOTH void visit_node(const void* nodes, Entry* stack) {
        const char* const node = static_cast<const char*>(nodes) + std::size_t{current} * node_bytes;
        const Words x = load16(node), y = load16(node + 16), z = load16(node + 32), child = load16(node + 48);
        float entry0 = box.t_min, exit0 = box.t_max, entry1 = box.t_min, exit1 = box.t_max;
        box.clip(0, as_float(x.x), as_float(x.z), entry0, exit0);
        box.clip(1, as_float(y.x), as_float(y.z), entry0, exit0);
        box.clip(2, as_float(z.x), as_float(z.z), entry0, exit0);
        box.clip(0, as_float(x.y), as_float(x.w), entry1, exit1);
        box.clip(1, as_float(y.y), as_float(y.w), entry1, exit1);
        box.clip(2, as_float(z.y), as_float(z.w), entry1, exit1);
        const bool hit0 = BoxRay::meets(entry0, exit0), hit1 = BoxRay::meets(entry1, exit1);
        const bool second_first = hit1 && !(hit0 && entry0 <= entry1);
        if (hit0 && hit1) stack[++top] = second_first ? child.x : child.y;
        current = hit0 || hit1 ? (second_first ? child.y : child.x) : stack[top--];
    }
};

}  // namespace raycache::gpu
