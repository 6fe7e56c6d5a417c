// The list of integrators: how it is asked, and what an integrator says of itself.
#include <catch2/catch.hpp>

#include "path_rays.hpp"
#include "tracer/paths/embree_traversal.hpp"
#include "tracer/render.hpp"
#include "tracer/simt/execution.hpp"
#include "traces/error.hpp"

using namespace raycache;
using namespace raycache::tracer;
using namespace raycache::tracer::test;
using Catch::Matchers::Contains;

TEST_CASE(
    "integrators: an unknown name is answered with the valid ones and the closest, wherever settings are checked") {
    for (const IntegratorEntry& entry : integrators())
        CHECK_THROWS_WITH(integrator_entry("photons"), Contains("'photons'") && Contains(entry.name));
    PathSettings settings;
    CHECK_NOTHROW(check(settings));
    settings.integrator = "pathh";
    CHECK_THROWS_AS(check(settings), UsageError);
    CHECK_THROWS_WITH(check(settings), Contains("did you mean 'path'?"));
    CHECK_THROWS_AS(sample_dimensions(settings), UsageError);
}

TEST_CASE("integrators: one that is not cut into stages runs as a megakernel alone") {
    const IntegratorEntry& path = integrator_entry("path");
    IntegratorEntry whole = path;
    whole.name = "whole";
    whole.stages = nullptr;
    const ExecutionSettings mega, wave{Execution::wavefront, "meister"};
    CHECK_NOTHROW(check_execution(mega, whole));
    CHECK_NOTHROW(check_execution(wave, path));
    CHECK_THROWS_AS(check_execution(wave, whole), UsageError);
    CHECK_THROWS_WITH(check_execution(wave, whole),
                      Contains("integrator whole") && Contains("expected execution megakernel"));
}

TEST_CASE("integrators: stages of a path end at its last bounce, or one ray later where bounce rays look for lights") {
    const auto plan = [](LightSampling lights, bool sun) {
        Scene scene = quad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
        if (sun) scene.sun = Sun{{0, 1, 0}, {1, 1, 1}, 0.1F};
        PathSettings settings;
        settings.bounces = 4;
        settings.lights = lights;
        return integrator_entry("path").stages(settings, Lights(scene));
    };
    CHECK(plan(LightSampling::automatic, true).last_vertex == 4);
    CHECK(plan(LightSampling::automatic, true).shadow_rays);
    CHECK(plan(LightSampling::bsdf, true).last_vertex == 5);
    CHECK_FALSE(plan(LightSampling::bsdf, true).shadow_rays);
    CHECK(plan(LightSampling::nee, false).last_vertex == 4);
    CHECK_FALSE(plan(LightSampling::nee, false).shadow_rays);
}

TEST_CASE("integrators: a picture is that of the integrator which its settings name") {
    const PreparedScene scene(icosphere(2), {});
    for (const IntegratorEntry& entry : integrators()) {
        INFO(entry.name);
        RenderSettings settings;
        settings.width = settings.height = 16;
        settings.paths.integrator = entry.name;
        settings.strategy.samples.spp = 1;
        settings.strategy.samples.width = 16;
        const Image image = render(scene, settings, {});
        const SamplingStrategy strategy(settings.strategy, entry.dimensions(settings.paths));
        const CameraRays camera(scene.camera(), 16, 16);
        EmbreeTraversal traversal(scene.embree());
        const auto integrator =
            entry.make({scene.scene(), camera, scene.lights(), scene.texels(), strategy, settings.paths, traversal,
                        scene.integrator_data(camera, settings.paths).get()});
        const auto base = strategy.base_point(0);
        const LaunchGrid grid(ThreadMap::tile, 16, 16, 1);
        for (std::uint32_t warp = 0; warp < grid.warps(); ++warp) {
            const WarpJobs jobs = grid.jobs(warp, 0);
            std::array<PathLane, traces::warp_lanes> lanes;
            std::array<Vec3, traces::warp_lanes> radiance{};
            for (unsigned l = 0; l < traces::warp_lanes; ++l) {
                const LaneJob& job = jobs.lane[l];
                lanes[l] = {job.x, job.y, job.y * 16 + job.x, job.sample, base.data()};
            }
            integrator->trace(jobs.mask, lanes, radiance);
            for (std::uint32_t m = jobs.mask; m != 0; m &= m - 1) {
                const auto l = static_cast<unsigned>(std::countr_zero(m));
                CHECK(image.pixels[lanes[l].pixel] == radiance[l]);
            }
        }
    }
}
