#include "tracer/simt/recording_worker.hpp"

#include "tracer/simt/make_traversal.hpp"

namespace raycache::tracer {

RecordingWorker::RecordingWorker(const PreparedScene& scene, const CameraRays& camera, const SamplingStrategy& strategy,
                                 const PathSettings& paths)
    : traversal(make_traversal(scene, recorder)),
      integrator(integrator_entry(paths.integrator)
                     .make({scene.scene(), camera, scene.lights(), scene.texels(), strategy, paths, *traversal})) {}

}  // namespace raycache::tracer
