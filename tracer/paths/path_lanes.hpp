// The state of up to 32 paths between two stages of the path integrator. A megakernel keeps it for one warp from the
// camera to the last vertex; a wavefront copies lanes of the same vertex from one set into another.
#pragma once

#include <cstdint>

#include "tracer/paths/bsdf/bsdf.hpp"
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
    /// Density per solid angle of the direction of `rays`, for weighing lights that it meets: infinite where a shadow
    /// ray could not have found them, 0 where shadow rays alone count.
    float scatter_pdf[count];
    std::uint8_t reflections[count], transmissions[count];  ///< bounces so far, by kind

    // Of the present vertex.
    Hit hits[count];
    Surface surface[count];
    Shading shading[count];  ///< only where the material is not diffuse

    // Between aim_at_light and collect_light.
    Ray shadow_rays[count];
    Vec3 contribution[count];  ///< what the light adds if nothing is in the way

    /// Makes lane `to` of this set the path in `lane` of another.
    void copy(unsigned to, const PathLanes& from, unsigned lane) {
        job[to] = from.job[lane];
        rays[to] = from.rays[lane];
        throughput[to] = from.throughput[lane];
        radiance[to] = from.radiance[lane];
        scatter_pdf[to] = from.scatter_pdf[lane];
        reflections[to] = from.reflections[lane];
        transmissions[to] = from.transmissions[lane];
        hits[to] = from.hits[lane];
        surface[to] = from.surface[lane];
        shading[to] = from.shading[lane];
        shadow_rays[to] = from.shadow_rays[lane];
        contribution[to] = from.contribution[lane];
    }
};

}  // namespace raycache::tracer
