// Depths and normals of a picture: where they lie in memory, and how exactly they are kept.
#include "tracer/paths/depth_buffer.hpp"

#include <catch2/catch.hpp>
#include <set>

#include "test_rays.hpp"
#include "traces/object_kind.hpp"

using namespace raycache;
using namespace raycache::tracer;
using namespace raycache::tracer::test;

TEST_CASE("depth buffer: each pixel has a place of its own, in rows or in tiles of 8 x 8 pixels") {
    for (const auto& [width, height] : {std::pair{1U, 1U}, {8U, 8U}, {9U, 7U}, {20U, 17U}})
        for (const DepthLayout layout : {DepthLayout::linear, DepthLayout::tiled}) {
            const DepthBuffer depths(width, height, {layout, 4}, 1);
            std::set<std::uint32_t> places;
            for (std::uint32_t y = 0; y < height; ++y)
                for (std::uint32_t x = 0; x < width; ++x) places.insert(depths.element(x, y));
            CHECK(places.size() == std::size_t{width} * height);
            CHECK(*places.rbegin() < depths.elements());
        }
    const DepthBuffer rows(20, 17, {DepthLayout::linear, 4}, 1), tiles(20, 17, {DepthLayout::tiled, 4}, 1);
    CHECK(rows.element(3, 2) == 43);
    CHECK(rows.elements() == 340);
    CHECK(tiles.element(3, 2) == 19);      // row 2 of the first tile
    CHECK(tiles.element(8, 0) == 64);      // the second tile
    CHECK(tiles.element(0, 8) == 3 * 64);  // the first of the second row of three
    CHECK(tiles.element(19, 16) == 8 * 64 + 3);
    CHECK(tiles.elements() == 9 * 64);
}

TEST_CASE("depth buffer: a depth is kept as near / z in 4 or 2 bytes, within the error that it states, never as sky") {
    for (const std::uint32_t bytes : {2U, 4U}) {
        DepthBuffer depths(8, 8, {DepthLayout::linear, bytes}, 0.1F);
        for (const float z : {0.1F, 0.10001F, 1.0F, 3.7F, 100.0F, 1500.0F, 1e5F, 1e7F, 1e18F}) {
            depths.set(5, z, {0, 0, -1});
            const float stored = depths.reciprocal(5);
            INFO(bytes << " bytes, " << z << " m");
            CHECK(stored > 0);
            CHECK(std::abs(depths.near() / stored - z) <= depths.error_of(stored) * z);
        }
        CHECK(depths.reciprocal(6) == 0);  // sky
        const auto regions = depths.regions();
        REQUIRE(regions.size() == 2);
        CHECK(regions[0].kind == traces::ObjectKind::depth);
        CHECK((regions[0].stride == bytes && regions[0].element_size == bytes && regions[0].count == 64));
        CHECK(regions[1].kind == traces::ObjectKind::normal);
        CHECK((regions[1].stride == 4 && regions[1].count == 64));
    }
    CHECK(rounded_to_half(1) == 1);
    CHECK(rounded_to_half(1 + 0x1p-11F) == 1);  // a tie, to even
    CHECK(rounded_to_half(1 + 0x1.8p-11F) == 1 + 0x1p-10F);
    CHECK(rounded_to_half(0x1.8p-24F) == 0x1p-23F);  // a tie between subnormals
}

TEST_CASE("depth buffer: normals come back within 6e-5 on each axis") {
    for (const Vec3 v : icosphere(4).positions) {
        const Vec3 n = normalize(v), back = unpack_unit(pack_unit(n));
        for (int axis = 0; axis < 3; ++axis) REQUIRE(std::abs(back[axis] - n[axis]) < 6e-5F);
    }
    for (const Vec3 n : {Vec3{0, 0, -1}, Vec3{0, 0, 1}, Vec3{1, 0, 0}, Vec3{0, -1, 0}})
        CHECK(length(unpack_unit(pack_unit(n)) - n) < 1e-6F);
}

TEST_CASE("depth buffer: it is drawn through the centres of pixels, depth along the view and normals towards the eye") {
    // A wall at z = -5 that covers the left half of the view, seen from the origin; from behind, so that it turns.
    Scene scene = quad({-50, -50, -5}, {-50, 50, -5}, {0, 50, -5}, {0, -50, -5});
    scene.cameras[0] = {"front", {0, 0, 0}, {0, 0, -1}, {0, 1, 0}, 90};
    const PreparedScene prepared(std::move(scene), {});
    const CameraRays camera(prepared.camera(), 8, 4);
    const DepthBuffer depths = draw_depth(prepared.scene(), camera, prepared.embree(), {});
    CHECK(depths.near() == Approx(5));
    for (std::uint32_t y = 0; y < 4; ++y)
        for (std::uint32_t x = 0; x < 8; ++x) {
            const std::uint32_t e = depths.element(x, y);
            CHECK(depths.reciprocal(e) == Approx(x < 4 ? 1 : 0));
            if (x < 4) CHECK(length(depths.normal(e) - Vec3{0, 0, -1}) < 1e-4F);
        }
    const Vec3 point = camera.unproject({2.5F, 1.5F}, 7);
    CHECK(camera.project(point).x == Approx(2.5F));
    CHECK(camera.project(point).y == Approx(1.5F));
    const Vec3 along = camera.to_view(camera.ray(2, 1, {0.5F, 0.5F}).direction);
    CHECK(length(normalize(point) - along) < 1e-6F);
}

TEST_CASE("depth buffer: a picture of the sky alone is all 0") {
    Scene scene = quad({-1, -1, 5}, {1, -1, 5}, {1, 1, 5}, {-1, 1, 5});
    scene.cameras[0] = {"away", {0, 0, 0}, {0, 0, -1}, {0, 1, 0}, 45};
    const PreparedScene prepared(std::move(scene), {});
    const DepthBuffer depths =
        draw_depth(prepared.scene(), CameraRays(prepared.camera(), 5, 3), prepared.embree(), {DepthLayout::tiled, 2});
    for (std::uint32_t e = 0; e < depths.elements(); ++e) CHECK(depths.reciprocal(e) == 0);
    CHECK(depths.near() > 0);
}
