// What a thread needs to trace warps and record what they read.
#pragma once

#include <memory>

#include "tracer/paths/integrators/integrator.hpp"
#include "tracer/prepared_scene.hpp"
#include "tracer/simt/recorder.hpp"

namespace raycache::tracer {

struct RecordingWorker {
    /// `data`: of the integrator, may be null; `own_regions`: index of the first of its regions in the trace.
    RecordingWorker(const PreparedScene&, const CameraRays&, const SamplingStrategy&, const PathSettings&,
                    const IntegratorData* data, std::uint8_t own_regions);
    RecordingWorker(const RecordingWorker&) = delete;  // its parts point at each other

    WarpRecorder recorder;
    std::unique_ptr<Traversal> traversal;
    std::unique_ptr<Integrator> integrator;
    PathLanes lanes;  ///< scratch of a wavefront's warp
};

}  // namespace raycache::tracer
