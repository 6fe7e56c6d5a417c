// The integrator where the answer is known, and against Embree as the traversal.
#include <catch2/catch.hpp>
#include <cmath>

#include "path_rays.hpp"
#include "tests/real_data.hpp"
#include "tracer/bvh/embree_scene.hpp"
#include "tracer/paths/directions.hpp"
#include "tracer/paths/embree_traversal.hpp"
#include "tracer/paths/surface.hpp"

using namespace raycache::tracer;
using namespace raycache::tracer::test;

namespace {

struct Pictures {
    std::uint32_t size = 32, samples = 1;
    PathSettings paths;
};

/// Mean radiance of `samples` pictures.
Vec3 mean(const PreparedScene& scene, Traversal& traversal, const Pictures& p) {
    const std::uint32_t warps = (p.size + 15) / 16 * ((p.size + 15) / 16) * 8;
    std::uint64_t asked = 0, enough = std::uint64_t{p.samples} * (warps + 1);
    const Vec3 sum = trace_pictures(scene, traversal, p.size, p.paths, [&] { return asked++ < enough; });
    return sum / static_cast<float>(std::size_t{p.size} * p.size * p.samples);
}

Vec3 mean(const PreparedScene& scene, const Pictures& p) {
    NullRecorder recorder;
    const auto traversal = make_traversal(scene, recorder);
    return mean(scene, *traversal, p);
}

Camera camera_at(Vec3 eye, Vec3 forward, Vec3 up, float fov) { return {"test", eye, forward, up, fov}; }

/// A sphere that fills the picture.
Scene sphere_in_sky(float albedo) {
    Scene scene = icosphere(4);
    scene.materials[0].base_color = {albedo, albedo, albedo};
    scene.sky = {1, 1, 1};
    scene.cameras = {camera_at({0, 0, 4}, {0, 0, -1}, {0, 1, 0}, 10)};
    return scene;
}

}  // namespace

TEST_CASE("paths: an empty view sees the sky") {
    Scene scene = sphere_in_sky(0.5F);
    scene.sky = {0.25F, 0.5F, 2};
    scene.cameras[0].forward = {0, 0, 1};
    const Vec3 seen = mean(PreparedScene(std::move(scene), {}), Pictures{});
    CHECK(seen.x == Approx(0.25));
    CHECK(seen.y == Approx(0.5));
    CHECK(seen.z == Approx(2));
}

TEST_CASE("paths: a convex body in a white furnace shows its albedo after one bounce and none before") {
    for (const float albedo : {0.25F, 0.5F, 1.0F}) {
        const PreparedScene scene(sphere_in_sky(albedo), {});
        CHECK(mean(scene, {32, 1, {0, false}}).x == 0);
        for (const std::uint32_t bounces : {1U, 2U, 8U})
            CHECK(mean(scene, {32, 1, {bounces, false}}).x == Approx(albedo).epsilon(1e-4));
    }
}

TEST_CASE("paths: inside a glowing sphere radiance is the geometric series of its albedo", "[slow]") {
    Scene scene = icosphere(5);
    scene.materials[0].base_color = {0.5F, 0.5F, 0.5F};
    scene.materials[0].emission = {1, 1, 1};
    scene.cameras = {camera_at({0.2F, 0.1F, 0}, {0, 0, -1}, {0, 1, 0}, 60)};
    const PreparedScene prepared(std::move(scene), {});
    double expected = 1, term = 1;
    for (std::uint32_t bounces = 0; bounces < 4; ++bounces) {
        expected += term *= 0.5;  // one more vertex, lit directly
        CHECK(mean(prepared, {64, 8, {bounces, false}}).x == Approx(expected).epsilon(0.01));
    }
}

TEST_CASE("paths: Russian roulette changes the noise and not the mean") {
    Scene scene = icosphere(3);
    scene.materials[0].base_color = {0.7F, 0.7F, 0.7F};
    scene.materials[0].emission = {1, 1, 1};
    scene.cameras = {camera_at({0.2F, 0.1F, 0}, {0, 0, -1}, {0, 1, 0}, 60)};
    const PreparedScene prepared(std::move(scene), {});
    const float without = mean(prepared, {64, 8, {8, false}}).x, with = mean(prepared, {64, 8, {8, true}}).x;
    CHECK(with != without);
    CHECK(with == Approx(without).epsilon(0.02));
}

TEST_CASE("paths: a floor under a sun shows albedo / pi times the irradiance, and nothing in a shadow") {
    Scene scene = quad({-10, 0, 10}, {10, 0, 10}, {10, 0, -10}, {-10, 0, -10});
    scene.materials[0].base_color = {0.5F, 0.25F, 1};
    scene.sun = Sun{normalize({0, 1, 1}), {2, 2, 2}, 0.001F};
    scene.cameras = {camera_at({0, 3, 0}, {0, -1, 0}, {0, 0, -1}, 30)};
    Scene shaded = scene;
    append(shaded, quad({-10, 5, 20}, {10, 5, 20}, {10, 5, -10}, {-10, 5, -10}));
    const Vec3 lit = mean(PreparedScene(std::move(scene), {}), {32, 1, {0, false}});
    const double expected = 2 * std::sqrt(0.5) / 3.14159265;
    CHECK(lit.x == Approx(0.5 * expected).epsilon(1e-3));
    CHECK(lit.y == Approx(0.25 * expected).epsilon(1e-3));
    CHECK(lit.z == Approx(expected).epsilon(1e-3));
    CHECK(mean(PreparedScene(std::move(shaded), {}), {32, 1, {0, false}}) == Vec3{});
}

TEST_CASE("paths: a ray that leaves a surface does not meet it again, near the origin and far from it") {
    for (const auto& [scale, offset] : {std::pair{1.0F, 0.0F}, {0.01F, 0.0F}, {100.0F, 0.0F}, {10.0F, 1000.0F}}) {
        Scene scene = moved(icosphere(3), scale, {offset, offset, offset});
        const Vec3 centre{offset, offset, offset};
        const PreparedScene prepared(std::move(scene), {});
        Random random(1);
        std::vector<Ray> rays(20000);
        for (Ray& ray : rays) {
            ray.origin = centre + random.direction() * (3 * scale);
            ray.direction = normalize(centre + random.direction() * (0.7F * scale) - ray.origin);
        }
        const auto hits = closest_hits(prepared, rays);
        std::vector<Ray> leaving;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            REQUIRE(hits[i].found());
            const Surface s = surface_at(prepared.scene(), rays[i], hits[i]);
            REQUIRE(dot(s.geometric_normal, rays[i].direction) <= 0);
            Ray out;
            out.direction = to_world(cosine_hemisphere({random.unit(), random.unit()}), s.geometric_normal);
            out.origin = s.leave(out.direction);
            leaving.push_back(out);
        }
        std::uint64_t met = 0;
        for (const Hit& hit : closest_hits(prepared, leaving)) met += hit.found();  // a convex body
        INFO("scale " << scale << " offset " << offset);
        CHECK(met == 0);
    }
}

TEST_CASE("paths: directions are unit, above the surface and cosine-distributed for every normal") {
    Random random(2);
    for (int i = 0; i < 1000; ++i) {
        const Vec3 normal = i == 0   ? Vec3{0, 0, -1}
                            : i == 1 ? Vec3{0, 0, 1}
                            : i == 2 ? Vec3{1, 0, -0.0F}
                                     : random.direction();
        double sum = 0;
        for (int k = 0; k < 100; ++k) {
            const Vec3 d = to_world(cosine_hemisphere({(static_cast<float>(k) + 0.5F) / 100, random.unit()}), normal);
            REQUIRE(length(d) == Approx(1).epsilon(1e-5));
            REQUIRE(dot(d, normal) > -1e-6F);
            sum += dot(d, normal);
        }
        REQUIRE(sum / 100 == Approx(2.0 / 3).epsilon(0.01));
    }
}

TEST_CASE("paths: a picture is the same with Embree in the traversal's place") {
    Scene scene = icosphere(3);
    scene.materials.resize(2);
    scene.materials[0].base_color = {0.8F, 0.5F, 0.3F};
    for (const Scene& wall : {quad({-2, -1, 2}, {2, -1, 2}, {2, -1, -2}, {-2, -1, -2}),
                              quad({-2, -1, -2}, {2, -1, -2}, {2, 3, -2}, {-2, 3, -2})})
        append(scene, wall);
    Scene light = quad({-0.5F, 2.9F, -0.5F}, {0.5F, 2.9F, -0.5F}, {0.5F, 2.9F, 0.5F}, {-0.5F, 2.9F, 0.5F});
    light.material_of = {1, 1};
    append(scene, light);
    scene.materials[1].emission = {20, 20, 20};
    scene.sky = {0.1F, 0.1F, 0.2F};
    scene.cameras = {camera_at({0, 1, 6}, {0, 0, -1}, {0, 1, 0}, 40)};
    const PreparedScene prepared(std::move(scene), {});
    const EmbreeScene embree(prepared.scene());
    EmbreeTraversal traversal(embree);
    const Pictures pictures{64, 4, {3, false}};
    const Vec3 ours = mean(prepared, pictures), theirs = mean(prepared, traversal, pictures);
    for (int axis = 0; axis < 3; ++axis) CHECK(ours[axis] == Approx(theirs[axis]).epsilon(1e-4));
    CHECK(ours.x > 0.01F);
}

TEST_CASE(
    "paths: a scene with holes, cut by texels and by alpha alone, is the same with Embree in the traversal's place") {
    Scene scene = soup(3000, 0.3F, 5);
    Material leaf = scene.materials[0], glass = scene.materials[0];
    leaf.alpha_mask = glass.alpha_mask = true;
    leaf.base_color_texture = 0;
    glass.alpha = 0.2F;
    scene.materials = {scene.materials[0], leaf, glass};
    for (std::size_t t = 0; t < scene.material_of.size(); ++t) scene.material_of[t] = t % 3;
    scene.textures.push_back({2, 1, {250, 250, 250, 255, 0, 0, 0, 0}, "half a leaf"});
    for (std::size_t p = 0; p < scene.positions.size(); ++p)
        scene.texcoords.push_back({static_cast<float>(p % 3) * 0.3F, 0.5F});
    scene.sky = {0.5F, 0.6F, 0.8F};
    scene.cameras = {camera_at({0, 0, 4}, {0, 0, -1}, {0, 1, 0}, 40)};
    Scene closed = scene;
    for (Material& m : closed.materials) m.alpha_mask = false;
    const PreparedScene prepared(std::move(scene), {}), solid(std::move(closed), {});
    EmbreeTraversal traversal(prepared.embree()), without_holes(solid.embree());
    const Pictures pictures{64, 4, {3, false}};
    const Vec3 ours = mean(prepared, pictures), theirs = mean(prepared, traversal, pictures);
    for (int axis = 0; axis < 3; ++axis) CHECK(ours[axis] == Approx(theirs[axis]).epsilon(1e-4));
    CHECK(ours.x != Approx(mean(solid, without_holes, pictures).x).epsilon(0.02));
}

TEST_CASE("paths: the Cornell box is the same with Embree in the traversal's place", "[slow][data]") {
    const auto path = raycache::test::real_scene("cornell_box.glb");
    if (!path) return;
    const PreparedScene prepared(load_gltf(*path, nullptr), {});
    const EmbreeScene embree(prepared.scene());
    EmbreeTraversal traversal(embree);
    const Pictures pictures{128, 8, {4, false}};
    const Vec3 ours = mean(prepared, pictures), theirs = mean(prepared, traversal, pictures);
    for (int axis = 0; axis < 3; ++axis) CHECK(ours[axis] == Approx(theirs[axis]).epsilon(1e-4));
    CHECK(ours.x > ours.z);  // red wall, green wall, warm light
}
