// The three ways of finding light give one picture; surfaces, limits and sizes that are extreme give the right one.
#include <catch2/catch.hpp>
#include <cmath>

#include "path_rays.hpp"
#include "tests/real_data.hpp"

using namespace raycache;
using namespace raycache::tracer;
using namespace raycache::tracer::test;

namespace {

struct Estimate {
    double mean = 0, error = 0;  ///< standard error
};

/// Mean brightness of a picture, from one picture after another.
Estimate estimate(const PreparedScene& scene, const PathSettings& paths, std::uint32_t size, std::uint32_t samples) {
    NullRecorder recorder;
    const auto traversal = make_traversal(scene, recorder);
    StrategySettings settings;
    settings.decorrelation = "random";
    settings.samples.spp = samples;
    settings.samples.seed = 1 + static_cast<std::uint64_t>(paths.lights);
    const SamplingStrategy strategy(settings, path_dimensions(paths.bounces));
    const CameraRays camera(scene.camera(), size, size);
    PathIntegrator integrator({scene.scene(), camera, scene.lights(), scene.texels(), strategy, paths, *traversal});
    const LaunchGrid grid(ThreadMap::tile, size, size, samples);
    double sum = 0, squares = 0;
    for (std::uint32_t sample = 0; sample < samples; ++sample) {
        const auto base = strategy.base_point(sample);
        double picture = 0;
        for (std::uint32_t warp = 0; warp < grid.warps(); ++warp) {
            const WarpJobs jobs = grid.jobs(warp, sample);
            std::array<PathLane, traces::warp_lanes> lanes;
            std::array<Vec3, traces::warp_lanes> radiance{};
            for (unsigned l = 0; l < traces::warp_lanes; ++l) {
                const LaneJob& job = jobs.lane[l];
                lanes[l] = {job.x, job.y, job.y * size + job.x, job.sample, base.data()};
            }
            if (jobs.mask != 0) integrator.trace(jobs.mask, lanes, radiance);
            for (std::uint32_t m = jobs.mask; m != 0; m &= m - 1)
                picture += double{luminance(radiance[static_cast<unsigned>(std::countr_zero(m))])};
        }
        picture /= static_cast<double>(size) * size;
        sum += picture;
        squares += picture * picture;
    }
    const double mean = sum / samples;
    return {mean, std::sqrt(std::max(0.0, squares / samples - mean * mean) / std::max(1U, samples - 1))};
}

bool agree(const Estimate& a, const Estimate& b) {
    INFO(a.mean << " +- " << a.error << " and " << b.mean << " +- " << b.error);
    CHECK(std::fabs(a.mean - b.mean) < 4 * std::hypot(a.error, b.error) + 1e-6 * a.mean);
    return std::isfinite(a.mean) && std::isfinite(b.mean);
}

Camera looking(Vec3 eye, float fov) { return {"test", eye, {0, 0, -1}, {0, 1, 0}, fov}; }

/// A sphere of `ball` in a grey room with a lamp below the ceiling and one open wall, behind the eye. Materials: ball,
/// walls, lamp.
Scene room(const Material& ball) {
    Scene scene = icosphere(3);
    scene.normals = scene.positions;
    scene.materials = {ball, {}, {}};
    scene.materials[1].base_color = {0.6F, 0.6F, 0.6F};
    scene.materials[2].emission = {8, 7, 6};
    scene.materials[2].base_color = {0, 0, 0};
    const auto wall = [&](const Scene& w, std::uint16_t material) {
        append(scene, w);
        scene.normals.resize(scene.positions.size());
        scene.material_of[scene.material_of.size() - 1] = scene.material_of[scene.material_of.size() - 2] = material;
    };
    wall(quad({-2, -1, 2}, {2, -1, 2}, {2, -1, -2}, {-2, -1, -2}), 1);
    wall(quad({-2, 3, -2}, {2, 3, -2}, {2, 3, 2}, {-2, 3, 2}), 1);
    wall(quad({-2, -1, -2}, {2, -1, -2}, {2, 3, -2}, {-2, 3, -2}), 1);
    wall(quad({-2, -1, 2}, {-2, -1, -2}, {-2, 3, -2}, {-2, 3, 2}), 1);
    wall(quad({2, -1, -2}, {2, -1, 2}, {2, 3, 2}, {2, 3, -2}), 1);
    wall(quad({-0.9F, 2.8F, -0.9F}, {0.9F, 2.8F, -0.9F}, {0.9F, 2.8F, 0.9F}, {-0.9F, 2.8F, 0.9F}), 2);
    scene.cameras = {looking({0, 1, 7}, 36)};
    return scene;
}

Material surface(float metallic, float roughness, float transmission = 0, bool thin = true) {
    Material m;
    m.base_color = {0.9F, 0.8F, 0.7F};
    m.metallic = metallic;
    m.roughness = roughness;
    m.transmission = transmission;
    m.thin = thin;
    return m;
}

PathSettings limits(std::uint32_t bounces, LightSampling lights = LightSampling::automatic,
                    std::uint32_t diffuse = max_bounces, std::uint32_t transmission = max_bounces) {
    return {bounces, false, diffuse, transmission, lights};
}

constexpr LightSampling all_modes[] = {LightSampling::automatic, LightSampling::bsdf, LightSampling::nee,
                                       LightSampling::mis};

void modes_agree(const PreparedScene& scene, const PathSettings& paths, std::uint32_t size, std::uint32_t samples) {
    PathSettings by_bsdf = paths;
    by_bsdf.lights = LightSampling::bsdf;
    const Estimate expected = estimate(scene, by_bsdf, size, 4 * samples);
    CHECK(expected.mean > 0);
    CHECK(expected.error < 0.02 * expected.mean);
    for (const LightSampling mode : {LightSampling::nee, LightSampling::mis, LightSampling::automatic}) {
        PathSettings other = paths;
        other.lights = mode;
        INFO("--lights " << to_string(mode));
        CHECK(agree(estimate(scene, other, size, samples), expected));
    }
}

/// `count` square panes one behind the other before the eye, in a white furnace.
Scene panes(std::uint32_t count, const Material& glass, bool solids) {
    Scene scene = mesh({}, {});
    for (std::uint32_t i = 0; i < count; ++i) {
        const float z = -1 - 0.1F * static_cast<float>(i);
        Scene pane = quad({-50, -50, z}, {50, -50, z}, {50, 50, z}, {-50, 50, z});
        // Every second one is the back of a slab.
        if (solids && i % 2 == 1) pane = quad({-50, -50, z}, {-50, 50, z}, {50, 50, z}, {50, -50, z});
        append(scene, pane);
    }
    scene.materials = {glass};
    scene.sky = {1, 1, 1};
    scene.cameras = {looking({0, 0, 0}, 20)};
    return scene;
}

}  // namespace

TEST_CASE("lights: bsdf, nee, mis and auto converge to one picture on every kind of surface", "[slow]") {
    for (const Material& ball : {surface(0, 1), surface(1, 0.3F), surface(1, 0), surface(0, 0.4F), surface(0, 0.02F),
                                 surface(0, 0, 1, false), surface(0, 0.4F, 1, false), surface(0, 0.4F, 0.5F, true)}) {
        INFO("metallic " << ball.metallic << " roughness " << ball.roughness << " transmission " << ball.transmission
                         << (ball.thin ? "" : " solid"));
        modes_agree(PreparedScene(room(ball), {}), limits(3), 24, 96);
    }
}

TEST_CASE("lights: the modes agree with few bounces, with limits per kind, and under a sky and a sun", "[slow]") {
    Material veil = surface(0, 1);
    veil.alpha_blend = true;
    veil.alpha = 0.4F;
    const PreparedScene rough(room(surface(0.5F, 0.3F, 0.5F, false)), {}), alpha(room(veil), {});
    for (const std::uint32_t bounces : {0U, 1U}) modes_agree(rough, limits(bounces), 16, 100);
    modes_agree(rough, limits(4, LightSampling::automatic, 1, 3), 16, 100);
    modes_agree(rough, limits(4, LightSampling::automatic, 4, 0), 16, 100);
    modes_agree(alpha, limits(2), 16, 100);
    Scene outdoors = room(surface(1, 0.4F));
    outdoors.sky = {0.3F, 0.4F, 0.5F};
    outdoors.sun = Sun{normalize({0.1F, 0.3F, 1}), {3, 3, 3}, 0.3F};
    modes_agree(PreparedScene(std::move(outdoors), {}), limits(2), 16, 100);
}

TEST_CASE("lights: the Cornell box is the same for bsdf, nee and mis", "[slow][data]") {
    const auto path = raycache::test::real_scene("cornell_box.glb");
    if (!path) return;
    modes_agree(PreparedScene(load_gltf(*path, nullptr), {}), limits(3), 32, 128);
}

TEST_CASE("lights: bsdf sends no shadow rays, nee the same rays as auto on diffuse surfaces") {
    const PreparedScene scene(room(surface(0, 1)), {});
    std::size_t shadow[4], closest[4];
    for (const LightSampling mode : all_modes) {
        RayCollector rays(scene);
        std::uint32_t asked = 0;
        trace_pictures(scene, rays, 16, limits(2, mode), [&] { return asked++ < 9; });
        shadow[static_cast<int>(mode)] = rays.shadow_rays.size();
        closest[static_cast<int>(mode)] = rays.closest_rays.size();
    }
    const auto at = [](LightSampling mode) { return static_cast<int>(mode); };
    CHECK(shadow[at(LightSampling::bsdf)] == 0);
    CHECK(shadow[at(LightSampling::nee)] > 100);
    for (const LightSampling mode : {LightSampling::mis, LightSampling::automatic}) {
        CHECK(shadow[at(mode)] == shadow[at(LightSampling::nee)]);
        CHECK(closest[at(mode)] == closest[at(LightSampling::nee)]);
    }
}

TEST_CASE("lights: a lamp and a sun of no size are defined: the lamp is dark, the sun shines by shadow rays alone") {
    Scene scene = room(surface(1, 0.3F));
    for (std::size_t i = scene.positions.size() - 4; i < scene.positions.size(); ++i) scene.positions[i] = {0, 2.8F, 0};
    for (const LightSampling mode : all_modes)
        CHECK(estimate(PreparedScene(scene, {}), limits(3, mode), 8, 2).mean == 0);
    scene.sun = Sun{normalize({0.1F, 0.3F, 1}), {3, 3, 3}, 0};
    const PreparedScene lit(scene, {});
    const Estimate sun = estimate(lit, limits(2, LightSampling::nee), 16, 64);
    CHECK(sun.mean > 0.1);
    CHECK(agree(estimate(lit, limits(2, LightSampling::mis), 16, 64), sun));
    CHECK(estimate(lit, limits(2, LightSampling::bsdf), 16, 4).mean == 0);
    scene.sun->angular_radius = 1e-3F;  // hardly any size: the same light
    CHECK(agree(estimate(PreparedScene(scene, {}), limits(2, LightSampling::nee), 16, 64), sun));
}

TEST_CASE("surfaces: a white sphere of any opaque material vanishes in a white furnace") {
    for (const float metallic : {0.0F, 1.0F})
        for (const float roughness : {0.0F, 1e-8F, 0.1F, 0.5F, 1.0F}) {
            Scene scene = icosphere(4);
            scene.normals = scene.positions;
            scene.materials[0].metallic = metallic;
            scene.materials[0].roughness = roughness;
            scene.sky = {1, 1, 1};
            scene.cameras = {looking({0, 0, 4}, 10)};
            INFO("metallic " << metallic << " roughness " << roughness);
            CHECK(estimate(PreparedScene(std::move(scene), {}), limits(4), 32, 4).mean == Approx(1).epsilon(0.015));
        }
}

TEST_CASE("surfaces: a chain of 24 transmissions loses no energy, and 23 are not enough for it") {
    Material clear = surface(0, 0, 1, true);
    clear.base_color = {1, 1, 1};
    clear.ior = 1;
    for (const bool solids : {false, true}) {
        clear.thin = !solids;
        const PreparedScene scene(panes(24, clear, solids), {});
        CHECK(estimate(scene, limits(24, LightSampling::automatic, 4, 24), 16, 1).mean == Approx(1).epsilon(1e-6));
        CHECK(estimate(scene, limits(28, LightSampling::automatic, 4, 24), 16, 1).mean == Approx(1).epsilon(1e-6));
        CHECK(estimate(scene, limits(28, LightSampling::automatic, 4, 23), 16, 1).mean == 0);
        CHECK(estimate(scene, limits(23), 16, 1).mean == 0);
    }
    // With reflections at every surface all light still gets out, on one side or the other.
    clear.ior = 1.5F;
    for (const bool solids : {false, true}) {
        clear.thin = !solids;
        CHECK(estimate(PreparedScene(panes(24, clear, solids), {}), limits(64), 16, 64).mean ==
              Approx(1).epsilon(0.02));
    }
}

TEST_CASE("surfaces: four panes pass the share that a stack of plates passes") {
    Material clear = surface(0, 0, 1, true);
    clear.base_color = {1, 1, 1};
    Scene scene = panes(4, clear, false);
    scene.sky = {};
    append(scene, quad({-50, -50, -9}, {50, -50, -9}, {50, 50, -9}, {-50, 50, -9}));
    scene.materials.resize(2);
    scene.materials[1].emission = {1, 1, 1};
    scene.materials[1].base_color = {0, 0, 0};
    scene.material_of[8] = scene.material_of[9] = 1;
    scene.cameras = {looking({0, 0, 0}, 2)};
    // Stokes 1862: n plates, each reflecting r, pass (1 - r) / (1 + (n - 1) r).
    const double r = 0.04, expected = (1 - r) / (1 + 3 * r);
    const PreparedScene prepared(std::move(scene), {});
    for (const LightSampling mode : all_modes)
        CHECK(estimate(prepared, limits(40, mode), 64, 8).mean == Approx(expected).epsilon(0.01));
}

TEST_CASE("surfaces: an eye inside glass sees the square of the index times the light outside") {
    Scene scene = icosphere(4);
    scene.normals = scene.positions;
    Material clear = surface(0, 0, 1, false);
    clear.base_color = {1, 1, 1};
    scene.materials = {clear};
    scene.sky = {1, 1, 1};
    scene.cameras = {looking({0, 0, 0}, 60)};
    CHECK(estimate(PreparedScene(scene, {}), limits(64), 16, 8).mean == Approx(2.25).epsilon(0.01));
    scene.materials[0].ior = 1;
    CHECK(estimate(PreparedScene(scene, {}), limits(64), 16, 1).mean == Approx(1).epsilon(1e-4));
    scene.cameras = {looking({0, 0, 4}, 10)};
    scene.materials[0].ior = 1.5F;
    CHECK(estimate(PreparedScene(scene, {}), limits(64), 32, 8).mean == Approx(1).epsilon(0.01));
}

TEST_CASE("surfaces: pictures of 0 to 64 bounces are finite and grow") {
    double before = 0;
    const PreparedScene scene(room(surface(0.5F, 0.2F, 0.5F, false)), {});
    for (const std::uint32_t bounces : {0U, 1U, 2U, 4U, 8U, 64U}) {
        const Estimate e = estimate(scene, limits(bounces), 16, 32);
        INFO(bounces << " bounces");
        CHECK(std::isfinite(e.mean));
        CHECK(e.mean > before - 4 * e.error);
        before = e.mean;
    }
}

TEST_CASE("surfaces: a scene a million times smaller or larger gives the same picture", "[slow]") {
    for (const Material& ball : {surface(0, 1), surface(0.5F, 0.2F, 0.5F, false)}) {
        const double expected = estimate(PreparedScene(room(ball), {}), limits(4), 24, 64).mean;
        for (const float scale : {1e-6F, 1e-3F, 1e3F, 1e6F}) {
            Scene scene = moved(room(ball), scale, {});
            scene.cameras[0].eye = scene.cameras[0].eye * scale;
            INFO("scale " << scale);
            CHECK(estimate(PreparedScene(std::move(scene), {}), limits(4), 24, 64).mean ==
                  Approx(expected).epsilon(0.01));
        }
    }
}

TEST_CASE("surfaces: alpha BLEND shows what is behind in its share") {
    Material veil = surface(0, 1);
    veil.base_color = {0, 0, 0};
    veil.alpha_blend = true;
    for (const float alpha : {0.0F, 0.25F, 1.0F}) {
        veil.alpha = alpha;
        const PreparedScene scene(panes(1, veil, false), {});
        CHECK(estimate(scene, limits(1), 64, 4).mean == Approx(1 - alpha).margin(0.02));
    }
}

TEST_CASE("surfaces: texels are read where a material has a texture, twice where it has two, and a mirror is one") {
    Scene scene = panes(1, surface(1, 1), false);
    scene.materials[0].base_color = {1, 1, 1};
    scene.textures = {{1, 1, {255, 0, 255, 255}, "smooth metal"}, {1, 1, {255, 255, 255, 255}, "white"}};
    scene.sky = {};
    // Behind the eye, only where a mirror at normal incidence shows it.
    append(scene, quad({-2, -2, 1}, {2, -2, 1}, {2, 2, 1}, {-2, 2, 1}));
    scene.texcoords.resize(scene.positions.size());
    scene.materials.resize(2);
    scene.materials[1].emission = {1, 1, 1};
    scene.materials[1].base_color = {0, 0, 0};
    scene.material_of[2] = scene.material_of[3] = 1;
    const auto texels_of = [&] {
        const PreparedScene prepared(scene, {});
        RayCollector rays(prepared);
        std::uint32_t asked = 0;
        trace_pictures(prepared, rays, 16, limits(0), [&] { return asked++ < 9; });
        return rays.texels;
    };
    constexpr std::size_t pixels = 256;
    CHECK(texels_of() == 0);
    CHECK(estimate(PreparedScene(scene, {}), limits(1), 16, 4).mean < 0.8);
    scene.materials[0].metallic_roughness_texture = 0;
    CHECK(texels_of() == pixels);
    CHECK(estimate(PreparedScene(scene, {}), limits(1), 16, 4).mean == Approx(1).epsilon(1e-3));
    scene.materials[0].base_color_texture = 1;
    CHECK(texels_of() == 2 * pixels);
}

TEST_CASE("lights: shadow rays that graze a lamp are not blocked by it, though they start beside the surface") {
    // Far from the origin the start moves by more than the slack at the ray's end.
    Scene scene = room(surface(0, 1));
    for (Vec3& p : scene.positions) p = p + Vec3{0, 60, 0};
    scene.cameras[0].eye = {0, 61, 7};
    scene.cameras[0].forward = normalize(Vec3{1.4F, 63, -1} - scene.cameras[0].eye);
    scene.cameras[0].up = normalize(cross(cross(scene.cameras[0].forward, {0, 1, 0}), scene.cameras[0].forward));
    scene.cameras[0].vertical_fov = 1;
    modes_agree(PreparedScene(std::move(scene), {}), limits(0), 16, 200);
}
