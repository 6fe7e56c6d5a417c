// Rays marched through a depth buffer, computed by hand.
#include <catch2/catch.hpp>
#include <cstdint>
#include <vector>

#include "tracer/paths/screen_ray.hpp"

using namespace raycache;
using namespace raycache::tracer;

namespace {

constexpr std::uint32_t size = 8;
constexpr Vec3 towards_camera{0, 0, -1}, to_the_right{1, 0, 0};

/// At the origin, 8 x 8 pixels, 90 degrees: a point at depth z lies at the pixel 4 + 4 x / z.
CameraRays square_camera() { return {{"", {0, 0, 0}, {0, 0, -1}, {0, 1, 0}, 90}, size, size}; }

/// A wall at depth 8 that faces the camera, and before its columns from 5 on another at depth 4.
DepthBuffer two_walls(DepthFormat format = {}) {
    DepthBuffer depths(size, size, format, 4);
    for (std::uint32_t y = 0; y < size; ++y)
        for (std::uint32_t x = 0; x < size; ++x) depths.set(depths.element(x, y), x < 5 ? 8.0F : 4.0F, towards_camera);
    return depths;
}

struct Marched {
    std::vector<std::uint32_t> columns;  ///< of the steps inside the picture, until one is blocked
    bool blocked = false;
};

/// From pixel (2, 4), whose point is (-3, -1, 8).
Marched march(const DepthBuffer& depths, const ScreenMarch& settings, Vec3 direction, float offset) {
    const CameraRays camera = square_camera();
    ScreenRay ray(depths, camera, settings, 2, 4, direction, offset);
    Marched out;
    std::uint32_t x = 0, y = 0;
    for (std::uint32_t i = 0; i < settings.steps && ray.step(i, depths, settings, x, y); ++i) {
        CHECK(y == 4);
        out.columns.push_back(x);
        out.blocked = ray.is_blocked(depths.reciprocal(depths.element(x, y)), x, y, depths, camera, settings);
        if (out.blocked) break;
    }
    return out;
}

}  // namespace

TEST_CASE("screen ray: along a wall it is blocked where another stands before it, by up to its thickness") {
    const DepthBuffer depths = two_walls();
    // Q = (3, -1, 8) lies at column 5.5: steps at 2.875, 3.625, 4.375, 5.125, the last one behind the wall at depth 4.
    const Marched reaches = march(depths, {6, 4, 4}, to_the_right, 0.5F);
    CHECK(reaches.columns == std::vector<std::uint32_t>{2, 3, 4, 5});
    CHECK(reaches.blocked);
    const Marched thin = march(depths, {6, 3.9F, 4}, to_the_right, 0.5F);  // 4 behind it
    CHECK(thin.columns == reaches.columns);
    CHECK_FALSE(thin.blocked);
    const Marched early = march(depths, {6, 4, 4}, to_the_right, 0);  // 2.5, 3.25, 4, 4.75
    CHECK(early.columns == std::vector<std::uint32_t>{2, 3, 4, 4});
    CHECK_FALSE(early.blocked);
    const Marched shorter = march(depths, {4, 4, 4}, to_the_right, 0.5F);  // to 4.5
    CHECK(shorter.columns == std::vector<std::uint32_t>{2, 3, 3, 4});
    CHECK_FALSE(shorter.blocked);
}

TEST_CASE("screen ray: steps are even on the screen, and the depth between is the perspective's") {
    // Q = (1, -1, 4) lies at column 5. Halfway on the screen 1 / z is the mean of 1/8 and 1/4, z = 5.33: a wall at 5.2
    // blocks the ray there, one at 5.5 stands behind it.
    const Vec3 way{4, 0, -4};
    const float distance = length(way);
    for (const float wall : {5.5F, 5.2F}) {
        DepthBuffer depths(size, size, {}, 4);
        for (std::uint32_t e = 0; e < depths.elements(); ++e) depths.set(e, 8, towards_camera);
        for (std::uint32_t y = 0; y < size; ++y) depths.set(depths.element(3, y), wall, towards_camera);
        const Marched m = march(depths, {distance, 8, 1}, way / distance, 0.5F);  // one step, halfway: column 3.75
        CHECK(m.columns == std::vector<std::uint32_t>{3});
        CHECK(m.blocked == (wall < 5.3F));
    }
}

TEST_CASE("screen ray: outside the picture nothing blocks, and no step is made") {
    const Marched left = march(two_walls(), {6, 8, 4}, -to_the_right, 0.5F);  // 2.125, 1.375, 0.625, -0.125
    CHECK(left.columns == std::vector<std::uint32_t>{2, 1, 0});
    CHECK_FALSE(left.blocked);
    const Marched far = march(two_walls(), {1e18F, 8, 1024}, to_the_right, 0.5F);
    CHECK(far.columns.empty());
    CHECK_FALSE(far.blocked);
}

TEST_CASE("screen ray: it goes no nearer to the camera than the nearest surface, however large the radius") {
    for (const float radius : {4.0F, 100.0F, 1e18F}) {
        const Marched m = march(two_walls(), {radius, radius, 4}, towards_camera, 0.5F);
        CHECK(m.columns.size() == 4);  // from column 2.5 to 1
        CHECK(m.columns.back() == 1);
        CHECK_FALSE(m.blocked);
    }
}

TEST_CASE("screen ray: of radius or thickness 0 it is never blocked") {
    const Marched nowhere = march(two_walls(), {0, 0, 3}, to_the_right, 0.5F);
    CHECK(nowhere.columns == std::vector<std::uint32_t>{2, 2, 2});
    CHECK_FALSE(nowhere.blocked);
    CHECK_FALSE(march(two_walls(), {6, 0, 4}, to_the_right, 0.5F).blocked);
}

TEST_CASE("screen ray: 2 bytes and tiles see the same walls as 4 bytes row by row") {
    for (const DepthLayout layout : {DepthLayout::linear, DepthLayout::tiled})
        for (const std::uint32_t bytes : {2U, 4U}) {
            CHECK(march(two_walls({layout, bytes}), {6, 4.1F, 4}, to_the_right, 0.5F).blocked);
            CHECK_FALSE(march(two_walls({layout, bytes}), {6, 3.9F, 4}, to_the_right, 0.5F).blocked);
        }
}
