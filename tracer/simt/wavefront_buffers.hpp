// The memory that the kernels of a wavefront hand to each other, as regions of a trace. A path has one slot for all its
// life: its place in the launch grid, warp by warp and lane by lane.
//
//   rays      32 B  per slot: origin, t_min, direction, t_max
//   paths     32 B  per slot: throughput, radiance, pixel, sample
//   hits      16 B  per slot: t, u, v, triangle
//   queues     4 B  two of one entry per slot: slots of the paths that go on; a vertex reads one and writes the other
//   shadows   48 B  per place in the vertex's list of shadow rays: the ray, what it carries, its slot
//   sort             what sorting a queue moves: per ray, and per run of equal keys where these are sorted as one
#pragma once

#include <cstdint>
#include <vector>

#include "tracer/simt/orders/sort_cost.hpp"
#include "traces/header.hpp"

namespace raycache::tracer {

/// Indices of the regions.
struct WavefrontBuffers {
    struct Buffer {
        std::uint8_t read = 0, write = 0;
    };
    Buffer rays, paths, hits, queues, shadows;
    std::uint8_t sort_rays = 0, sort_runs = 0;  ///< 0: none
    std::uint32_t slots = 0;

    std::uint32_t queue_entry(std::uint32_t vertex, std::uint32_t place) const { return vertex % 2 * slots + place; }
};

/// Appends the regions of a wavefront with `slots` path slots to those of the scene.
WavefrontBuffers add_wavefront_buffers(std::vector<traces::Region>&, std::uint32_t slots, const SortCost&);

}  // namespace raycache::tracer
