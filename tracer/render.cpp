#include "tracer/render.hpp"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <cmath>
#include <memory>

#include "tracer/paths/embree_traversal.hpp"
#include "tracer/paths/integrators/integrator.hpp"
#include "tracer/simt/thread_map.hpp"
#include "traces/error.hpp"
#include "traces/memory_budget.hpp"

namespace raycache::tracer {
namespace {

struct Worker {
    Worker(const PreparedScene& scene, const CameraRays& camera, const SamplingStrategy& strategy,
           const PathSettings& paths, const IntegratorData* data)
        : traversal(scene.embree()),
          integrator(
              integrator_entry(paths.integrator)
                  .make({scene.scene(), camera, scene.lights(), scene.texels(), strategy, paths, traversal, data})) {}
    Worker(const Worker&) = delete;  // its parts point at each other

    EmbreeTraversal traversal;
    std::unique_ptr<Integrator> integrator;
};

Vec3 clamped(Vec3 radiance, std::optional<float> limit) {
    if (!limit) return radiance;
    const float most = max_component(radiance);
    return most > *limit ? radiance * (*limit / most) : radiance;
}

}  // namespace

void check_clamp(std::optional<float> clamp) {
    if (clamp && !(std::isfinite(*clamp) && *clamp > 0))
        throw UsageError(fmt::format("--clamp {}; expected a radiance above 0, such as 10", *clamp));
}

Image render(const PreparedScene& scene, const RenderSettings& settings,
             const std::function<void(std::uint64_t paths)>& progress) {
    StrategySettings of_picture = settings.strategy;
    of_picture.samples.width = settings.width;
    const SamplingStrategy strategy(of_picture, sample_dimensions(settings.paths));
    const CameraRays camera(scene.camera(), settings.width, settings.height);
    const std::uint64_t spp = settings.strategy.samples.spp;
    const LaunchGrid grid(ThreadMap::tile, settings.width, settings.height, spp);

    scene.embree();  // built here, not by whichever worker comes first
    const std::shared_ptr<const IntegratorData> data = scene.integrator_data(camera, settings.paths);
    const std::uint64_t pixels = std::uint64_t{settings.width} * settings.height;
    MemoryBudget().check(pixels * sizeof(Vec3), fmt::format("{} x {} pixels", settings.width, settings.height),
                         "the picture");
    Image image{settings.width, settings.height, std::vector<Vec3>(std::size_t{settings.width} * settings.height)};
    tbb::enumerable_thread_specific<std::unique_ptr<Worker>> workers(
        [&] { return std::make_unique<Worker>(scene, camera, strategy, settings.paths, data.get()); });

    // All warps of one sample index before the next: base points are computed once and memory stays that of one.
    for (std::uint64_t sample = 0; sample < spp; ++sample) {
        const std::vector<std::uint32_t> base = strategy.base_point(sample);
        tbb::parallel_for(tbb::blocked_range<std::uint32_t>(0, grid.warps(), 16), [&](const auto& range) {
            std::uint64_t paths = 0;
            for (std::uint32_t warp = range.begin(); warp != range.end(); ++warp) {
                const WarpJobs jobs = grid.jobs(warp, static_cast<std::uint32_t>(sample));
                if (jobs.mask == 0) continue;
                std::array<PathLane, traces::warp_lanes> lanes;
                std::array<Vec3, traces::warp_lanes> radiance;
                for (unsigned l = 0; l < traces::warp_lanes; ++l) {
                    const LaneJob& job = jobs.lane[l];
                    lanes[l] = {job.x, job.y, job.y * settings.width + job.x, job.sample, base.data()};
                }
                workers.local()->integrator->trace(jobs.mask, lanes, radiance);
                for (unsigned l = 0; l < traces::warp_lanes; ++l) {
                    if (((jobs.mask >> l) & 1U) == 0) continue;
                    image.pixels[lanes[l].pixel] += clamped(radiance[l], settings.clamp) / static_cast<float>(spp);
                    ++paths;
                }
            }
            if (progress) progress(paths);
        });
    }
    return image;
}

}  // namespace raycache::tracer
