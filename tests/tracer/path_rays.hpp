// The rays that a path tracer sends through a scene.
#pragma once

#include <bit>
#include <vector>

#include "test_rays.hpp"
#include "tracer/paths/integrators/path_integrator.hpp"
#include "tracer/simt/thread_map.hpp"

namespace raycache::tracer::test {

/// Walks rays as WarpTraversal does and keeps them.
class RayCollector final : public Traversal {
public:
    explicit RayCollector(const PreparedScene& scene) : traversal_(make_traversal(scene, recorder_)) {}

    void closest(std::uint32_t mask, traces::RayType type, std::uint8_t bounce, const Ray* rays, Hit* hits) override {
        keep(mask, rays, closest_rays);
        traversal_->closest(mask, type, bounce, rays, hits);
    }
    std::uint32_t occluded(std::uint32_t mask, traces::RayType type, std::uint8_t bounce, const Ray* rays) override {
        keep(mask, rays, shadow_rays);
        return traversal_->occluded(mask, type, bounce, rays);
    }
    void read_texels(std::uint32_t mask, traces::RayType, std::uint8_t, const std::uint32_t*) override {
        texels += static_cast<std::size_t>(std::popcount(mask));
    }

    std::vector<Ray> closest_rays, shadow_rays;
    std::size_t texels = 0;  ///< read for shading

private:
    static void keep(std::uint32_t mask, const Ray* rays, std::vector<Ray>& out) {
        for (; mask != 0; mask &= mask - 1) out.push_back(rays[std::countr_zero(mask)]);
    }
    NullRecorder recorder_;
    std::unique_ptr<Traversal> traversal_;
};

/// Traces pictures of `size` x `size` pixels with one sample after another by `traversal` while `go_on()` says so.
/// Returns the sum of all paths' radiance.
template <class GoOn>
Vec3 trace_pictures(const PreparedScene& scene, Traversal& traversal, std::uint32_t size, const PathSettings& paths,
                    GoOn go_on) {
    constexpr std::uint32_t spp = 4096;
    StrategySettings settings;
    settings.decorrelation = "random";
    settings.samples.spp = spp;
    const SamplingStrategy strategy(settings, path_dimensions(paths.bounces));
    const CameraRays camera(scene.camera(), size, size);
    PathIntegrator integrator({scene.scene(), camera, scene.lights(), scene.texels(), strategy, paths, traversal});
    const LaunchGrid grid(ThreadMap::tile, size, size, spp);
    double sum[3] = {};
    for (std::uint32_t sample = 0; sample < spp && go_on(); ++sample) {
        const auto base = strategy.base_point(sample);
        for (std::uint32_t warp = 0; warp < grid.warps() && go_on(); ++warp) {
            const WarpJobs jobs = grid.jobs(warp, sample);
            if (jobs.mask == 0) continue;
            std::array<PathLane, traces::warp_lanes> lanes;
            std::array<Vec3, traces::warp_lanes> radiance{};
            for (unsigned l = 0; l < traces::warp_lanes; ++l) {
                const LaneJob& job = jobs.lane[l];
                lanes[l] = {job.x, job.y, job.y * size + job.x, job.sample, base.data()};
            }
            integrator.trace(jobs.mask, lanes, radiance);
            for (std::uint32_t m = jobs.mask; m != 0; m &= m - 1)
                for (int axis = 0; axis < 3; ++axis)
                    sum[axis] += radiance[static_cast<unsigned>(std::countr_zero(m))][axis];
        }
    }
    return {static_cast<float>(sum[0]), static_cast<float>(sum[1]), static_cast<float>(sum[2])};
}

/// Makes the scene comparable with Embree: no holes, and lit from outside where it has no light.
inline Scene opaque(Scene scene) {
    for (Material& m : scene.materials) m.alpha_mask = false;
    scene.sky = {1, 1, 1};
    if (!scene.sun) scene.sun = Sun{normalize({0.35F, 0.9F, 0.25F}), {1, 1, 1}};
    return scene;
}

}  // namespace raycache::tracer::test
