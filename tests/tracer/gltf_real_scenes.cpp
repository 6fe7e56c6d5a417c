// The scenes of SCENES.md, where they are at hand (tests/real_data.hpp).
#include <catch2/catch.hpp>

#include "tests/real_data.hpp"
#include "tests/tracer/gltf_files.hpp"

using namespace raycache;
using namespace raycache::tracer;
using namespace raycache::tracer::test;

namespace {

struct ExpectedCamera {
    const char* name;
    Vec3 eye, look_at;
    float vertical_fov;
};

struct ExpectedScene {
    const char* file;
    std::size_t triangles, materials, textures, emissive_triangles, zero_area_triangles;
    Vec3 lower, upper;
    std::vector<ExpectedCamera> cameras;
};

const std::vector<ExpectedScene> expected_scenes{
    {"sponza.glb",
     262267,
     25,
     21,
     0,
     1,
     {-19.209F, -1.264F, -11.828F},
     {17.999F, 14.294F, 11.054F},
     {{"atrium", {-11, 1.7F, -0.4F}, {0, 2.6F, -0.3F}, 60}, {"gallery", {-12.3F, 6.2F, 4.2F}, {0, 4.5F, -1.5F}, 65}}},
    {"san_miguel.glb",
     9407479,
     290,
     222,
     2,
     4424,
     {-37.974F, -0.463F, -36.951F},
     {46.774F, 53.520F, 36.936F},
     {{"courtyard", {10, 3, 6}, {20, 2, 3}, 65},
      {"camera09", {27.6255F, 1.49616F, 2.42353F}, {26.6582F, 1.48803F, 2.17012F}, 60},
      {"camera25", {6.37319F, 1.53861F, 5.62511F}, {7.09618F, 1.64532F, 4.94254F}, 65},
      {"upstairs_camera20", {6.18231F, 7.12809F, 5.32462F}, {6.91043F, 7.09695F, 4.63988F}, 65}}},
    {"bistro_interior.glb",
     1046609,
     74,
     44,
     2386,
     6,
     {-2.062F, 0.227F, -13.942F},
     {15.301F, 7.511F, 5.471F},
     {{"dining_room", {3, 2, 1.5F}, {9, 1.2F, -5}, 65}, {"along_bar", {8.5F, 1.9F, 2}, {4, 1.3F, -5}, 65}}},
    {"country_kitchen.glb",
     1021809,
     86,
     11,
     0,
     889,
     {-3.139F, -0.021F, -3.184F},
     {3.777F, 3.364F, 5.471F},
     {{"original_wide", {1.211F, 1.805F, 3.852F}, {0.335F, 1.721F, 2.056F}, 50}}},
    {"white_room.glb",
     400407,
     66,
     13,
     8,
     71,
     {-2.584F, -0.166F, 0.370F},
     {3.150F, 3.225F, 8.183F},
     {{"original", {2.25F, 1.312F, 6.179F}, {1.382F, 1.238F, 4.379F}, 58.72F}}},
    {"contemporary_bathroom.glb",
     380290,
     31,
     6,
     2,
     533,
     {-2.898F, -0.011F, -2.5F},
     {2.5F, 2.792F, -0.05F},
     {{"original", {0.007F, 0.912F, -0.228F}, {-1.497F, 0.943F, -1.546F}, 55}}},
    {"wooden_staircase.glb",
     262660,
     26,
     9,
     2,
     764,
     {-4.107F, -0.163F, -5.204F},
     {2.503F, 7.158F, 5.134F},
     {{"hall", {1.2F, 1.6F, 0.8F}, {-1.5F, 2.2F, -4}, 70},
      {"original", {0.032F, 1.527F, 4.882F}, {0.017F, 1.617F, 2.884F}, 58.54F}}},
    {"cornell_box.glb",
     32,
     4,
     0,
     2,
     0,
     {0, 0, -5.592F},
     {5.56F, 5.488F, 0},
     {{"original", {2.78F, 2.73F, 8}, {2.78F, 2.73F, 0}, 39.3F}}},
};

std::size_t count_emissive(const Scene& scene) {
    std::size_t count = 0;
    for (const std::uint16_t m : scene.material_of) count += max_component(scene.materials[m].emission) > 0;
    return count;
}

std::size_t count_without_area(const Scene& scene) {
    std::size_t count = 0;
    for (std::size_t t = 0; t < scene.triangle_count(); ++t) {
        const Vec3 a = corner(scene, t, 0), b = corner(scene, t, 1), c = corner(scene, t, 2);
        const double e[3] = {double{b.x} - a.x, double{b.y} - a.y, double{b.z} - a.z};
        const double f[3] = {double{c.x} - a.x, double{c.y} - a.y, double{c.z} - a.z};
        count += e[1] * f[2] == e[2] * f[1] && e[2] * f[0] == e[0] * f[2] && e[0] * f[1] == e[1] * f[0];
    }
    return count;
}

}  // namespace

TEST_CASE("each real scene has the triangles, materials, bounds and cameras that SCENES.md lists", "[slow][data]") {
    for (const ExpectedScene& expected : expected_scenes) {
        const auto path = raycache::test::real_scene(expected.file);
        if (!path) continue;
        INFO(expected.file);
        const Scene scene = load_file(*path).scene;
        CHECK(scene.triangle_count() == expected.triangles);
        CHECK(scene.indices.size() == 3 * expected.triangles);
        CHECK(scene.materials.size() == expected.materials);
        CHECK(scene.textures.size() == expected.textures);
        CHECK(count_emissive(scene) == expected.emissive_triangles);
        const Box bounds = scene.bounds();
        CHECK(length(bounds.lower - expected.lower) < 1e-3F);
        CHECK(length(bounds.upper - expected.upper) < 1e-3F);
        REQUIRE(scene.cameras.size() == expected.cameras.size());
        for (std::size_t i = 0; i < scene.cameras.size(); ++i) {
            const Camera& camera = scene.cameras[i];
            const ExpectedCamera& e = expected.cameras[i];
            CHECK(camera.name == e.name);
            CHECK(length(camera.eye - e.eye) < 1e-4F);
            CHECK(length(camera.forward - normalize(e.look_at - e.eye)) < 1e-4F);
            CHECK(std::abs(dot(camera.forward, camera.up)) < 1e-5F);
            CHECK(camera.up.y > 0);
            CHECK(camera.vertical_fov == Approx(e.vertical_fov).margin(1e-3));
        }
        CHECK(count_without_area(scene) == expected.zero_area_triangles);
    }
}

TEST_CASE("fronts agree with the stored normals in the scene that mirrors instances", "[slow][data]") {
    const auto path = raycache::test::real_scene("san_miguel.glb");
    if (!path) return;
    const Scene scene = load_file(*path).scene;
    std::size_t agree = 0, compared = 0;
    for (std::size_t t = 0; t < scene.triangle_count(); t += 7) {
        const Vec3 n = scene.normals[scene.indices[3 * t]];
        const float cosine = dot(face_normal(scene, t), n);
        if (std::abs(cosine) < 0.2F) continue;
        ++compared;
        agree += cosine > 0;
    }
    CHECK(compared > 1000000);
    CHECK(static_cast<double>(agree) > 0.99 * static_cast<double>(compared));
}
