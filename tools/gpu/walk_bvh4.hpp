// How a lane steps through nodes of layout `bvh4` (128 bytes, of which seven loads bring 112), as
// tracer/bvh/layouts/bvh4_lane.hpp does.
#pragma once

#include "tools/gpu/walk_refs.hpp"

namespace raycache::gpu {

struct WalkBvh4 : RefLane {
    static constexpr const char* name = "bvh4";
    static constexpr std::uint32_t node_bytes = 128;
    /// Three siblings at each of 97 levels, and the end.
    static constexpr std::uint32_t most_stack = 292;

    RAYCACHE_BOTH static std::uint32_t part(const Words& w, int i) {
        return i == 0 ? w.x : i == 1 ? w.y : i == 2 ? w.z : w.w;
    }
    RAYCACHE_BOTH void visit_node(const void* nodes, Entry* stack) {
        const char* const node = static_cast<const char*>(nodes) + std::size_t{current} * node_bytes;
        Words planes[6];
        for (int i = 0; i < 6; ++i) planes[i] = load16(node + 16 * i);
        const Words child = load16(node + 96);
        // Children that are hit, the nearest first; of equal ones the first child first. Places are constants once the
        // loops are unrolled, so that the lists stay in registers.
        float distance[4];
        std::uint32_t ref[4];
        std::uint32_t count = 0;
        for (int c = 0; c < 4; ++c) {
            float entry = box.t_min, exit = box.t_max;
            for (int axis = 0; axis < 3; ++axis)
                box.clip(axis, as_float(part(planes[axis], c)), as_float(part(planes[axis + 3], c)), entry, exit);
            const bool hit = BoxRay::meets(entry, exit);
            float t = entry;
            std::uint32_t r = part(child, c);
            bool moved = false;  // from its place on, everything moves back by one
            for (int i = 0; i < 4; ++i) {
                if (i >= c) break;
                const bool used = static_cast<std::uint32_t>(i) < count;
                const bool here = hit && used && (moved || distance[i] > t);
                const float kept_t = distance[i];
                const std::uint32_t kept = ref[i];
                if (here) {
                    distance[i] = t;
                    ref[i] = r;
                    t = kept_t;
                    r = kept;
                    moved = true;
                }
            }
            for (int i = 0; i < 4; ++i)
                if (hit && static_cast<std::uint32_t>(i) == count) {
                    distance[i] = t;
                    ref[i] = r;
                }
            count += hit ? 1 : 0;
        }
        for (int i = 3; i > 0; --i)
            if (static_cast<std::uint32_t>(i) < count) stack[++top] = ref[i];
        current = count != 0 ? ref[0] : stack[top--];
    }
};

}  // namespace raycache::gpu
