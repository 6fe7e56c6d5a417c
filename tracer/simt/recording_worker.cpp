#include "tracer/simt/recording_worker.hpp"

#include "tracer/simt/make_traversal.hpp"
#include "tracer/simt/region_traversal.hpp"

namespace raycache::tracer {
namespace {

std::unique_ptr<Traversal> traversal_of(const IntegratorEntry& integrator, const PreparedScene& scene,
                                        WarpRecorder& recorder, std::uint8_t own_regions) {
    if (integrator.walks_bvh) return make_traversal(scene, recorder, own_regions);
    return std::make_unique<RegionTraversal>(recorder, own_regions);
}

}  // namespace

RecordingWorker::RecordingWorker(const PreparedScene& scene, const CameraRays& camera, const SamplingStrategy& strategy,
                                 const PathSettings& paths, const IntegratorData* data, std::uint8_t own_regions)
    : traversal(traversal_of(integrator_entry(paths.integrator), scene, recorder, own_regions)),
      integrator(
          integrator_entry(paths.integrator)
              .make({scene.scene(), camera, scene.lights(), scene.texels(), strategy, paths, *traversal, data})) {}

}  // namespace raycache::tracer
