// The stages of the integrator keep everything in PathLanes: paths that move between sets of lanes end the same.
#include <catch2/catch.hpp>

#include "path_rays.hpp"

using namespace raycache;
using namespace raycache::tracer;
using namespace raycache::tracer::test;

namespace {

constexpr std::uint32_t all = ~0U;

/// A glass and a metal ball on a white floor under a lamp.
Scene balls() {
    Scene scene = icosphere(2);
    append(scene, moved(icosphere(2), 0.5F, {1.3F, -0.5F, 0.8F}));
    const std::size_t half = scene.material_of.size() / 2;
    for (std::size_t t = half; t < scene.material_of.size(); ++t) scene.material_of[t] = 1;
    append(scene, quad({-9, -1, 9}, {9, -1, 9}, {9, -1, -9}, {-9, -1, -9}));
    append(scene, quad({-2, 4, -2}, {2, 4, -2}, {2, 4, 2}, {-2, 4, 2}));
    scene.materials.resize(4);
    const std::size_t n = scene.material_of.size();
    scene.material_of[n - 4] = scene.material_of[n - 3] = 2;
    scene.material_of[n - 2] = scene.material_of[n - 1] = 3;
    scene.materials[0].transmission = 1;
    scene.materials[0].thin = false;
    scene.materials[0].roughness = 0;
    scene.materials[1].metallic = 1;
    scene.materials[1].roughness = 0.4F;
    scene.materials[3].emission = {5, 5, 5};
    scene.sky = {0.2F, 0.3F, 0.4F};
    scene.cameras = {{"test", {0, 0.5F, 5}, {0, 0, -1}, {0, 1, 0}, 40}};
    return scene;
}

}  // namespace

TEST_CASE("paths: lanes that change places at every vertex give the radiance of those that stay") {
    const PreparedScene scene(balls(), {});
    PathSettings paths;
    paths.bounces = 6;
    paths.bounces_diffuse = 2;
    paths.lights = LightSampling::mis;
    StrategySettings settings;
    settings.decorrelation = "random";
    settings.samples.spp = 4;
    const SamplingStrategy strategy(settings, path_dimensions(paths.bounces));
    const CameraRays camera(scene.camera(), 32, 32);
    NullRecorder recorder;
    const auto traversal = make_traversal(scene, recorder);
    PathIntegrator integrator({scene.scene(), camera, scene.lights(), scene.texels(), strategy, paths, *traversal});
    const auto base = strategy.base_point(1);
    std::uint32_t lit = 0;
    for (std::uint32_t row = 0; row < 32; ++row) {
        std::array<PathLane, traces::warp_lanes> jobs;
        for (std::uint32_t l = 0; l < traces::warp_lanes; ++l) jobs[l] = {l, row, row * 32 + l, 1, base.data()};
        std::array<Vec3, traces::warp_lanes> expected{};
        integrator.trace(all, jobs, expected);

        PathLanes sets[2];
        for (unsigned l = 0; l < traces::warp_lanes; ++l) sets[0].job[l] = jobs[l];
        integrator.generate(all, sets[0]);
        traversal->closest(all, traces::RayType::camera, 0, sets[0].rays, sets[0].hits);
        std::array<Vec3, traces::warp_lanes> found{};
        // Ended lanes hand in their radiance; the others move on, turned by 5 places, into the other set.
        const auto move = [&](std::uint32_t before, std::uint32_t alive, const PathLanes& from, PathLanes& to) {
            std::uint32_t mask = 0;
            for (unsigned l = 0; l < traces::warp_lanes; ++l) {
                if (((alive >> l) & 1U) != 0) {
                    to.copy((l + 5) % 32, from, l);
                    mask |= 1U << ((l + 5) % 32);
                } else if (((before >> l) & 1U) != 0) {
                    found[from.job[l].x] = from.radiance[l];
                }
            }
            return mask;
        };
        unsigned now = 0;
        std::uint32_t alive = all;
        for (std::uint32_t vertex = 0; alive != 0; ++vertex) {
            const auto bounce = static_cast<std::uint8_t>(vertex);
            const auto stage = [&](std::uint32_t going) {
                alive = move(alive, going, sets[now], sets[1 - now]);
                now = 1 - now;
            };
            stage(integrator.arrive(alive, vertex, sets[now]));
            stage(integrator.shade(alive, vertex, sets[now]));
            const std::uint32_t shadow = integrator.aim_at_light(alive, vertex, sets[now]);
            const std::uint32_t blocked =
                shadow == 0 ? 0 : traversal->occluded(shadow, traces::RayType::shadow, bounce, sets[now].shadow_rays);
            integrator.collect_light(shadow & ~blocked, sets[now]);
            stage(integrator.scatter(alive, vertex, sets[now]));
            if (alive != 0) traversal->closest(alive, traces::RayType::bounce, bounce, sets[now].rays, sets[now].hits);
        }
        for (unsigned l = 0; l < traces::warp_lanes; ++l) {
            CHECK(found[l] == expected[l]);
            lit += max_component(found[l]) > 0;
        }
    }
    CHECK(lit > 500);
}
