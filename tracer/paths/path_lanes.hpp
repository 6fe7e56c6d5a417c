// The state of up to 32 paths between two stages of the path integrator. A megakernel keeps it for one warp from the
// camera to the last vertex; a wavefront copies lanes of the same vertex from one set into another.
#pragma once

#include <cstdint>

#include "tracer/paths/surface.hpp"
#include "tracer/ray.hpp"
#include "tracer/vec.hpp"
#include "traces/record.hpp"

namespace raycache::tracer {

/// What a lane works on.
struct PathLane {
    std::uint32_t x = 0, y = 0;
    std::uint32_t pixel = 0;              ///< y * width + x: identifies the pixel to the decorrelation
    std::uint32_t sample = 0;             ///< sample index
    const std::uint32_t* base = nullptr;  ///< SamplingStrategy::base_point(sample)
};

/// One array per quantity. A lane means something only while it is in the mask that a stage returned.
struct PathLanes {
    static constexpr unsigned count = traces::warp_lanes;

    // Carried from vertex to vertex.
    PathLane job[count];
    Ray rays[count];  ///< the ray that is to be walked next, or that led to `hits`
    Vec3 throughput[count];
    Vec3 radiance[count];  ///< the path's estimate so far

    // Of the present vertex.
    Hit hits[count];
    Surface surface[count];

    // Between aim_at_light and collect_light.
    Ray shadow_rays[count];
    Vec3 contribution[count];  ///< what the light adds if nothing is in the way

    /// Makes lane `to` of this set the path in `lane` of another.
    void copy(unsigned to, const PathLanes& from, unsigned lane) {
        job[to] = from.job[lane];
        rays[to] = from.rays[lane];
        throughput[to] = from.throughput[lane];
        radiance[to] = from.radiance[lane];
        hits[to] = from.hits[lane];
        surface[to] = from.surface[lane];
        shadow_rays[to] = from.shadow_rays[lane];
        contribution[to] = from.contribution[lane];
    }
};

}  // namespace raycache::tracer
