// Embree asserts what it is given; nothing that a scene or a camera can cause may reach such an assert.
#include <catch2/catch.hpp>
#include <limits>
#include <utility>
#include <vector>

#include "tracer/bvh/embree_scene.hpp"
#include "tracer/paths/camera_rays.hpp"
#include "tracer/render.hpp"

using namespace raycache::tracer;

namespace {

/// One triangle in the plane z = 0, `size` metres wide.
Scene triangle(float size) {
    Scene scene;
    scene.positions = {{-size, -size, 0}, {size, -size, 0}, {0, size, 0}};
    scene.indices = {0, 1, 2};
    scene.material_of = {0};
    scene.materials = {Material{}};
    scene.cameras = {Camera{}};
    scene.sky = {1, 1, 1};
    return scene;
}

constexpr float infinity = std::numeric_limits<float>::infinity(), none = std::numeric_limits<float>::quiet_NaN();

}  // namespace

TEST_CASE("rays that Embree does not take meet nothing") {
    const Scene scene = triangle(1);
    const EmbreeScene embree(scene);
    const Ray good{{0, 0, 1}, {0, 0, -1}};
    CHECK(embree.intersect(good).found());
    CHECK(embree.occluded(good));
    for (const float bad : {none, infinity, -infinity, 1.9e18F, -3e38F}) {
        for (Ray ray : {Ray{{bad, 0, 1}, {0, 0, -1}}, Ray{{0, 0, bad}, {0, 0, -1}}, Ray{{0, 0, 1}, {0, bad, -1}},
                        Ray{{0, 0, 1}, {0, 0, bad}}}) {
            CHECK_FALSE(embree.intersect(ray).found());
            CHECK_FALSE(embree.occluded(ray));
        }
    }
    const std::vector<std::pair<float, float>> intervals{{none, infinity}, {0, none}, {-1, infinity}, {2, 1}};
    for (const auto& [t_min, t_max] : intervals) {
        const Ray ray{{0, 0, 1}, {0, 0, -1}, t_min, t_max};
        CHECK_FALSE(embree.intersect(ray).found());
        CHECK_FALSE(embree.occluded(ray));
    }
    CHECK_NOTHROW(embree.intersect({{0, 0, 1}, {0, 0, 0}}));  // no direction at all
}

TEST_CASE("scenes of any size and cameras at any place within the limits make a picture of finite numbers") {
    for (const float size : {1e18F, 1e15F, 1e10F, 1.0F, 1e-10F, 1e-20F, 1e-38F}) {
        for (const float distance : {1e18F, 1e10F, 3.0F, 1e-18F, 0.0F}) {
            Scene scene = triangle(size);
            scene.cameras[0].eye = {0, 0, distance};
            for (const float fov : {1e-30F, 45.0F, 179.99998F}) {
                scene.cameras[0].vertical_fov = fov;
                const PreparedScene prepared(scene, {});
                RenderSettings settings;
                settings.width = settings.height = 4;
                settings.strategy.samples.spp = 2;
                settings.paths.bounces = 3;
                const Image image = render(prepared, settings, {});
                INFO("size " << size << ", distance " << distance << ", field of view " << fov);
                for (const Vec3 pixel : image.pixels) REQUIRE(is_finite(pixel));
            }
        }
    }
}

TEST_CASE("a field of view just below half a turn is not mirrored") {
    Camera camera;
    camera.vertical_fov = 179.99998F;
    CHECK(CameraRays(camera, 8, 8).ray(0, 0, {0.5F, 0.5F}).direction.y > 0);
}
