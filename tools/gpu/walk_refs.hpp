// What lanes of layouts have in common whose nodes name their children one by one (tracer/bvh/layouts/child_ref.hpp): a
// stack of such names.
#pragma once

#include "tools/gpu/walk_ray.hpp"

namespace raycache::gpu {

struct RefLane {
    using Entry = std::uint32_t;
    static constexpr std::uint32_t leaf_bit = 0x80000000U, nothing = leaf_bit;
    /// Added to a run of triangles: that without its first.
    static constexpr std::uint32_t next_triangle = 7;

    BoxRay box;
    std::uint32_t current;  ///< a node, what is left of a leaf, or nothing
    std::uint32_t top;      ///< of the stack, whose entry 0 is the end

    /// At the root, or at its end.
    RAYCACHE_BOTH void start(const PackedRay& ray, Entry* stack, bool active) {
        box.set(ray);
        stack[0] = nothing;
        top = 0;
        current = active ? 0 : nothing;
    }
    RAYCACHE_BOTH void shorten(float t) { box.t_max = t; }
    RAYCACHE_BOTH bool at_node() const { return (current & leaf_bit) == 0; }
    RAYCACHE_BOTH bool at_triangles() const { return !at_node() && current != nothing; }
    RAYCACHE_BOTH std::uint32_t take_triangle() {
        const std::uint32_t element = (current & ~leaf_bit) >> 3;
        current += next_triangle;
        return element;
    }
    RAYCACHE_BOTH bool more_triangles() const { return (current & 7) != 0; }
    RAYCACHE_BOTH void leave_triangles(Entry* stack) { current = stack[top--]; }
    RAYCACHE_BOTH void end() { current = nothing; }
};

}  // namespace raycache::gpu
