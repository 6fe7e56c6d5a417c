// What a thread needs to trace warps and record what they read.
#pragma once

#include "tracer/paths/path_integrator.hpp"
#include "tracer/prepared_scene.hpp"
#include "tracer/simt/recorder.hpp"
#include "tracer/simt/warp_traversal.hpp"

namespace raycache::tracer {

struct RecordingWorker {
    RecordingWorker(const PreparedScene& scene, const CameraRays& camera, const SamplingStrategy& strategy,
                    const PathSettings& paths)
        : traversal(scene.scene(), scene.bvh(), scene.texels(), recorder),
          integrator(scene.scene(), camera, scene.lights(), scene.texels(), strategy, paths, traversal) {}
    RecordingWorker(const RecordingWorker&) = delete;  // its parts point at each other

    WarpRecorder recorder;
    WarpTraversal<WarpRecorder> traversal;
    PathIntegrator<WarpTraversal<WarpRecorder>> integrator;
    PathLanes lanes;  ///< scratch of a wavefront's warp
};

}  // namespace raycache::tracer
