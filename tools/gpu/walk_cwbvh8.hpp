// How a lane steps through nodes of layout `cwbvh8` (80 bytes, five loads), as tracer/bvh/layouts/cwbvh8_lane.hpp does.
#pragma once

#include "tools/gpu/walk_ray.hpp"

namespace raycache::gpu {

struct WalkCwbvh8 {
    static constexpr const char* name = "cwbvh8";
    static constexpr std::uint32_t node_bytes = 80;
    /// One group at each of 97 levels, and one more.
    static constexpr std::uint32_t most_stack = 98;
    static constexpr std::uint32_t first_inner = 24;
    /// Nodes still to be visited, of one parent: see Cwbvh8Lane.
    struct Entry {
        std::uint32_t first_node, bits;
    };

    BoxRay box;
    std::uint32_t octant, top;
    Entry nodes;
    std::uint32_t triangles, first_triangle;  ///< a bit each, of those to be tested; where they stand
    std::uint32_t node;
    bool walking;  ///< stands at a node, or at triangles

    RAYCACHE_BOTH void start(const PackedRay& ray, Entry*, bool active) {
        box.set(ray);
        octant = 7U ^ ((box.negative[0] ? 4U : 0U) | (box.negative[1] ? 2U : 0U) | (box.negative[2] ? 1U : 0U));
        top = 0;
        nodes = {0, 0};
        triangles = first_triangle = node = 0;
        walking = active;
    }
    RAYCACHE_BOTH void shorten(float t) { box.t_max = t; }
    RAYCACHE_BOTH bool at_node() const { return walking && triangles == 0; }
    RAYCACHE_BOTH bool at_triangles() const { return walking && triangles != 0; }

    RAYCACHE_BOTH void visit_node(const void* all, Entry* stack) {
        const char* const at = static_cast<const char*>(all) + std::size_t{node} * node_bytes;
        const Words n0 = load16(at), n1 = load16(at + 16), n2 = load16(at + 32), n3 = load16(at + 48),
                    n4 = load16(at + 64);
        const float origin[3] = {as_float(n0.x), as_float(n0.y), as_float(n0.z)};
        const float scale[3] = {as_float((n0.w & 0xff) << 23), as_float((n0.w >> 8 & 0xff) << 23),
                                as_float((n0.w >> 16 & 0xff) << 23)};
        // Four slots each: lower planes of x, y, z, then upper ones.
        const std::uint32_t steps[2][6] = {{n2.x, n2.z, n3.x, n3.z, n4.x, n4.z}, {n2.y, n2.w, n3.y, n3.w, n4.y, n4.w}};
        std::uint32_t bits = 0;
        for (int half = 0; half < 2; ++half) {
            const std::uint32_t metas = half == 0 ? n1.z : n1.w;
            for (int i = 0; i < 4; ++i) {
                float entry = box.t_min, exit = box.t_max;
                for (int axis = 0; axis < 3; ++axis) {
                    const auto plane = [&](int row) {
                        return origin[axis] + static_cast<float>(steps[half][row] >> (8 * i) & 0xff) * scale[axis];
                    };
                    box.clip(axis, plane(axis), plane(axis + 3), entry, exit);
                }
                const std::uint32_t meta = metas >> (8 * i) & 0xff;
                std::uint32_t place = meta & 31;
                if (place >= first_inner) place ^= octant;
                if (BoxRay::meets(entry, exit)) bits |= (meta >> 5) << place;
            }
        }
        nodes = {n1.x, (bits & 0xff000000U) | n0.w >> 24};
        triangles = bits & 0x00ffffffU;
        first_triangle = n1.y;
        if (triangles == 0) next_node(stack);
    }

    RAYCACHE_BOTH std::uint32_t take_triangle() {
        const std::uint32_t element = first_triangle + lowest_bit(triangles);
        triangles &= triangles - 1;
        return element;
    }
    RAYCACHE_BOTH bool more_triangles() const { return triangles != 0; }
    RAYCACHE_BOTH void leave_triangles(Entry* stack) { next_node(stack); }
    RAYCACHE_BOTH void end() { walking = false; }

    RAYCACHE_BOTH void next_node(Entry* stack) {
        if (nodes.bits >> 24 == 0) {
            walking = top != 0;
            if (!walking) return;
            nodes = stack[--top];
        }
        const std::uint32_t highest = highest_bit(nodes.bits);
        const std::uint32_t slot = (highest - first_inner) ^ octant;
        node = nodes.first_node + count_bits(nodes.bits & ((1U << slot) - 1));
        nodes.bits &= ~(1U << highest);
        if (nodes.bits >> 24 != 0) stack[top++] = nodes;
    }
};

}  // namespace raycache::gpu
