// Scenes far from the origin, beside outliers and of extreme size are traced as if they stood at the origin.
#include <catch2/catch.hpp>

#include "gltf_files.hpp"
#include "path_rays.hpp"
#include "tracer/render.hpp"

using namespace raycache;
using namespace raycache::tracer;
using namespace raycache::tracer::test;

namespace {

using Place = std::array<double, 3>;

/// A grey room, closed, around the origin of its node, and the eye in it.
struct Room {
    GltfBuilder builder;
    Vec3 half{1, 1, 1};
    Vec3 vertex_offset{0, 0, 0};

    int box() {
        std::vector<float> corners;
        for (int i = 0; i < 8; ++i)
            for (const float x :
                 {(i & 4) != 0 ? half.x : -half.x, (i & 2) != 0 ? half.y : -half.y, (i & 1) != 0 ? half.z : -half.z})
                corners.push_back(x);
        for (std::size_t i = 0; i < corners.size(); ++i) corners[i] += vertex_offset[static_cast<int>(i % 3)];
        const std::vector<std::uint32_t> index{0, 1, 3, 0, 3, 2, 4, 6, 7, 4, 7, 5, 0, 4, 5, 0, 5, 1,
                                               2, 3, 7, 2, 7, 6, 0, 2, 6, 0, 6, 4, 1, 5, 7, 1, 7, 3};
        const json grey = {{"pbrMetallicRoughness",
                            {{"baseColorFactor", {0.5, 0.5, 0.5, 1}}, {"metallicFactor", 0}, {"roughnessFactor", 1}}}};
        return builder.mesh({{"attributes", {{"POSITION", builder.floats(corners, "VEC3")}}},
                             {"indices", builder.accessor(index, "SCALAR", 5125)},
                             {"material", builder.add("materials", grey)}});
    }
    void eye(const Place& place) {
        const json lens = {{"type", "perspective"}, {"perspective", {{"yfov", 1.7}, {"znear", 0.01}}}};
        builder.node({{"camera", builder.add("cameras", lens)}, {"translation", place}});
    }
    void outlier(Vec3 at, float size) {
        builder.place(
            {{"attributes",
              {{"POSITION",
                builder.floats({at.x, at.y, at.z, at.x + size, at.y, at.z, at.x, at.y + size, at.z}, "VEC3")}}}});
    }
};

Room room_at(const Place& place, Vec3 half = {1, 1, 1}) {
    Room room;
    room.half = half;
    room.eye(place);
    room.builder.node({{"mesh", room.box()}, {"translation", place}});
    return room;
}

struct Traced {
    float brightest = 0;  ///< of the picture that Embree makes
    float light = 0;      ///< of all paths of our own traversal
    std::size_t rays = 0;
    std::vector<std::string> warnings;
};

Traced trace(const GltfBuilder& builder, SceneRequest request = {}) {
    const TempFolder folder;
    Traced result;
    request.source = folder.write("room.glb", builder.glb());
    request.sky = SceneRequest::Sky::on;
    Scene scene = load_scene(request, [&](const std::string& w) { result.warnings.push_back(w); });
    scene.sun.reset();
    const PreparedScene prepared(std::move(scene), {});
    RenderSettings settings;
    settings.width = settings.height = 16;
    settings.strategy.samples.spp = 16;
    settings.paths.bounces = 4;
    for (const Vec3 pixel : render(prepared, settings, {}).pixels)
        result.brightest = std::max(result.brightest, max_component(pixel));
    RayCollector rays(prepared);
    int asked = 0;
    result.light = max_component(trace_pictures(prepared, rays, 16, settings.paths, [&] { return asked++ < 72; }));
    result.rays = rays.closest_rays.size();
    return result;
}

void check_closed(const Traced& traced, std::size_t rays) {
    CHECK(traced.brightest == 0);
    CHECK(traced.light == 0);
    CHECK(traced.rays == rays);
}

}  // namespace

TEST_CASE("frame: a closed room is black inside and has as many rays wherever its node stands") {
    const std::size_t rays = trace(room_at({0, 0, 0}).builder).rays;
    CHECK(rays > 10000);
    for (const double far : {1e2, 1e3, 12345.678, 1e5, 1e7, 3.7e9, 1e12}) {
        INFO(far);
        const Traced traced = trace(room_at({far, -far, far}).builder);
        check_closed(traced, rays);
        CHECK(traced.warnings.empty());
    }
    check_closed(trace(room_at({500000.25, 50.5, 4500000.125}, {5, 1.5F, 5}).builder), rays);
}

TEST_CASE("frame: a huge translation and its inverse in the parent cancel") {
    Room room;
    room.eye({0, 0, 0});
    const int inner =
        room.builder.node({{"mesh", room.box()}, {"translation", {1e12, -1e12, 1e12}}, {"scale", {1000, 1000, 1000}}});
    room.builder.node({{"children", {inner}}, {"translation", {-1e9, 1e9, -1e9}}, {"scale", {1e-3, 1e-3, 1e-3}}});
    room.builder.doc["scenes"] = {{{"nodes", {0, 2}}}};
    check_closed(trace(room.builder), trace(room_at({0, 0, 0}).builder).rays);
}

TEST_CASE("frame: outliers do not move what the camera stands in, nor open it") {
    const std::size_t rays = trace(room_at({0, 0, 0}).builder).rays;
    for (const float far : {1e4F, 1e7F, 1e10F, 1e15F}) {
        Room room = room_at({0, 0, 0});
        room.outlier({far, 0, 0}, far / 100);
        INFO(far);
        check_closed(trace(room.builder), rays);
    }
    Random random(7);
    Room amid = room_at({1e5, 0, 1e5});
    for (int i = 0; i < 100; ++i) amid.outlier(random.direction() * 1e7F, 1e5F);
    check_closed(trace(amid.builder), rays);
    Room without_camera;
    without_camera.builder.node({{"mesh", without_camera.box()}, {"translation", {1e7, 1e7, 1e7}}});
    without_camera.outlier({-1e9F, 0, 0}, 1e5F);
    SceneRequest request;
    request.eye = Vec3d(1e7, 1e7, 1e7);
    request.look_at = Vec3d(1e7, 1e7, 1e7 - 1);
    request.vertical_fov = 1.7F * 180 / 3.14159265F;
    check_closed(trace(without_camera.builder, request), rays);
}

TEST_CASE("frame: a room of any size is closed, and as bright as any other where it is open") {
    for (const float size : {1e-15F, 1e-12F, 1e-6F, 1e9F, 1e12F, 1e15F}) {
        Room room;
        room.half = {size, size, size};
        room.eye({0, 0, 0});
        room.builder.node({{"mesh", room.box()}});
        INFO(size);
        check_closed(trace(room.builder), trace(room_at({0, 0, 0}).builder).rays);
    }
    const auto quad = [](float s) {
        Room room;
        room.eye({0, 0, 3 * double{s}});
        room.builder.place(
            {{"attributes", {{"POSITION", room.builder.floats({-s, -s, 0, s, -s, 0, 0, s, 0}, "VEC3")}}}});
        return trace(room.builder).light;
    };
    const float light = quad(1);
    for (const float size : {1e-16F, 1e-11F, 1e-6F, 1e6F, 1e10F, 1e16F})
        CHECK(quad(size) == Approx(light).epsilon(0.01));
}

TEST_CASE("frame: places that a user gives or reads are in the world") {
    SceneRequest request;
    request.eye = Vec3d(4500000.25, 0.5, -4500000.125);
    request.look_at = Vec3d(4500000.25, 0.5, -4500009.125);
    const TempFolder folder;
    Room far = room_at({4500000.0, 0, -4500000.0});
    request.source = folder.write("far.glb", far.builder.glb());
    const Scene scene = load_scene(request, {});
    CHECK_FALSE(scene.frame == SceneFrame{});
    CHECK(scene.frame.to_world(scene.cameras[0].eye) == *request.eye);
    CHECK(scene.frame.to_world(scene.cameras[1].eye) == Vec3d(4500000.0, 0, -4500000.0));
    CHECK(scene.cameras[0].forward == Vec3{0, 0, -1});
    CHECK(scene.frame.to_world(scene.positions[0]) == Vec3d(4499999.0, -1, -4500001.0));
}

TEST_CASE("frame: a scene near the origin for its size keeps its coordinates") {
    for (const double place : {0.0, 5.0, 100.0}) {
        const Scene scene = load(room_at({place, 0, -place}).builder).scene;
        CHECK(scene.frame == SceneFrame{});
        CHECK(scene.positions[0] == Vec3{static_cast<float>(place) - 1, -1, -static_cast<float>(place) - 1});
    }
}

TEST_CASE("frame: what float cannot resolve is said in one line that names the place and a remedy") {
    SECTION("vertices that carry the distance themselves") {
        Room room;
        room.vertex_offset = {1e6F, 0, 1e6F};
        room.eye({1e6, 0, 1e6});
        room.builder.node({{"mesh", room.box()}});
        const Traced traced = trace(room.builder);
        check_closed(traced, trace(room_at({0, 0, 0}).builder).rays);
        REQUIRE(traced.warnings.size() == 1);
        CHECK(traced.warnings[0].find("node 1's vertices lie 1e+06 m from its origin") != std::string::npos);
    }
    SECTION("a second room too far from the first") {
        Room room = room_at({0, 0, 0});
        room.builder.node({{"mesh", room.box()}, {"translation", {4e6, 0, 0}}});
        const Traced traced = trace(room.builder);
        REQUIRE(traced.warnings.size() == 1);
        CHECK(traced.warnings[0].find("too far for float from 0,0,0") != std::string::npos);
        CHECK(traced.warnings[0].find("node 2's") != std::string::npos);
    }
}
