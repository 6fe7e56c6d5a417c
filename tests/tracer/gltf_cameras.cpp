#include <catch2/catch.hpp>

#include "tests/tracer/gltf_files.hpp"
#include "tracer/scene/gltf_cameras.hpp"

using namespace raycache;
using namespace raycache::tracer;
using namespace raycache::tracer::test;

namespace {

GltfBuilder with_camera(const json& camera, json node = json::object()) {
    GltfBuilder builder;
    builder.place_triangle();
    node["camera"] = builder.add("cameras", camera);
    builder.node(node);
    return builder;
}

json perspective(double yfov) { return {{"type", "perspective"}, {"perspective", {{"yfov", yfov}, {"znear", 0.1}}}}; }

}  // namespace

TEST_CASE("a camera takes its place, direction and name from its node and its field of view from the camera") {
    const auto [scene, warnings] = load(with_camera(
        perspective(1.0471975512), {{"name", "left"}, {"translation", {1, 2, 3}}, {"rotation", {0, 1, 0, 1}}}));
    REQUIRE(scene.cameras.size() == 1);
    const Camera& camera = scene.cameras[0];
    CHECK(camera.name == "left");
    CHECK(camera.eye == Vec3{1, 2, 3});
    CHECK(length(camera.forward - Vec3{-1, 0, 0}) < 1e-6F);
    CHECK(length(camera.up - Vec3{0, 1, 0}) < 1e-6F);
    CHECK(camera.vertical_fov == Approx(60));
    CHECK(warnings.empty());
}

TEST_CASE("cameras come in the order of their nodes, whatever the order of the walk") {
    GltfBuilder builder;
    builder.place_triangle();
    const int a = builder.add("cameras", perspective(1)), b = builder.add("cameras", perspective(1));
    builder.node({{"name", "first"}, {"camera", b}});
    builder.node({{"name", "second"}, {"camera", a}});
    builder.doc["scenes"] = {{{"nodes", {2, 0, 1}}}};
    const Scene scene = load(builder).scene;
    REQUIRE(scene.cameras.size() == 2);
    CHECK(scene.cameras[0].name == "first");
    CHECK(scene.cameras[1].name == "second");
}

TEST_CASE("a camera without a node name goes by its own or by its number") {
    json named = perspective(1);
    named["name"] = "lens";
    CHECK(load(with_camera(named)).scene.cameras[0].name == "lens");
    CHECK(load(with_camera(perspective(1))).scene.cameras[0].name == "camera0");
}

TEST_CASE("cameras that make no perspective picture are skipped with a warning") {
    GltfBuilder builder;
    SECTION("orthographic") {
        builder = with_camera(
            {{"type", "orthographic"}, {"orthographic", {{"xmag", 1}, {"ymag", 1}, {"znear", 0.1}, {"zfar", 10}}}});
    }
    SECTION("no field of view") { builder = with_camera(perspective(0)); }
    SECTION("negative field of view") { builder = with_camera(perspective(-1)); }
    SECTION("field of view beyond half a turn") { builder = with_camera(perspective(4)); }
    SECTION("flattened by its node") { builder = with_camera(perspective(1), {{"scale", {0, 0, 0}}}); }
    const auto [scene, warnings] = load(builder);
    REQUIRE(scene.cameras.size() == 1);
    CHECK(scene.cameras[0].name == "auto");
    REQUIRE(warnings.size() == 1);
    CHECK(warnings[0].find("skipped 1") != std::string::npos);
}

TEST_CASE("a camera beyond the limit of vertices says so, and its place stays in the order of cameras") {
    for (const double far : {1.1e18, -1e19, 1e30, 1e200}) {
        const auto [scene, warnings] = load(with_camera(perspective(1), {{"translation", {0, far, 0}}}));
        REQUIRE(scene.cameras.size() == 1);
        CHECK(scene.cameras[0].problem.find("expected an eye within 1e+18 m") == 0);
        CHECK(warnings.empty());
    }
    CHECK(load(with_camera(perspective(1), {{"translation", {1e18, -1e18, 0}}})).scene.cameras[0].problem.empty());
}

TEST_CASE("a camera's direction survives any scale of its node") {
    for (const double scale : {1e-300, 1e-30, 1e30, 1e300}) {
        const Scene scene =
            load(with_camera(perspective(1), {{"rotation", {0, 1, 0, 1}}, {"scale", {scale, scale, scale}}})).scene;
        REQUIRE(scene.cameras.size() == 1);
        CHECK(length(scene.cameras[0].forward - Vec3{-1, 0, 0}) < 1e-6F);
        CHECK(length(scene.cameras[0].up - Vec3{0, 1, 0}) < 1e-6F);
    }
}

TEST_CASE("a scene too large to be seen whole from within the limits has no automatic camera") {
    CHECK_FALSE(overview_camera(Box{{-1e18F, -1e18F, -1e18F}, {1e18F, 1e18F, 1e18F}}).problem.empty());
    CHECK(overview_camera(Box{{-1e17F, -1e17F, -1e17F}, {1e17F, 1e17F, 1e17F}}).problem.empty());
}

TEST_CASE("a camera without the numbers it needs is an error") {
    for (const json& camera : {json{{"type", "perspective"}}, json{{"type", "fisheye"}}, json::object(),
                               json{{"type", "perspective"}, {"perspective", {{"znear", 1}}}}}) {
        const std::string message = error_of(with_camera(camera));
        INFO(message);
        CHECK(message.find("cameras[0].") != std::string::npos);
        CHECK(message.find('\n') == std::string::npos);
    }
}

TEST_CASE("a file without a camera gets one that has the whole scene in view") {
    GltfBuilder builder;
    builder.place({{"attributes", {{"POSITION", builder.floats({-3, 7, 0, 40, 0, -2, 0, 1, 90}, "VEC3")}}}});
    const Scene scene = load(builder).scene;
    REQUIRE(scene.cameras.size() == 1);
    const Camera& camera = scene.cameras[0];
    CHECK(camera.name == "auto");
    CHECK(std::abs(dot(camera.forward, camera.up)) < 1e-6F);
    const float half_fov = std::tan(camera.vertical_fov * 3.14159265F / 360);
    const Vec3 right = cross(camera.forward, camera.up);
    for (const Vec3 p : scene.positions) {
        const Vec3 d = p - camera.eye;
        const float depth = dot(d, camera.forward);
        CHECK(depth > 0);
        CHECK(std::abs(dot(d, camera.up)) < half_fov * depth);
        CHECK(std::abs(dot(d, right)) < half_fov * depth);
    }
}

TEST_CASE("a scene that is a single point still gets a camera apart from it") {
    const Camera camera = overview_camera(Box{{1, 1, 1}, {1, 1, 1}});
    CHECK(length(camera.eye - Vec3{1, 1, 1}) > 0);
    CHECK(is_finite(camera.forward));
}

TEST_CASE("an automatic camera looks at most of the triangles, and says what it leaves out far away") {
    GltfBuilder builder;
    std::vector<float> cluster;
    for (int i = 0; i < 30; ++i)
        for (const float x : {static_cast<float>(i), 0.0F, 0.0F, static_cast<float>(i) + 1, 0.0F, 0.0F,
                              static_cast<float>(i), 1.0F, 0.0F})
            cluster.push_back(x);
    builder.place({{"attributes", {{"POSITION", builder.floats(cluster, "VEC3")}}}});
    const auto near = load(builder);
    CHECK(near.warnings.empty());
    builder.place({{"attributes", {{"POSITION", builder.floats({1e7F, 0, 0, 1.1e7F, 0, 0, 1e7F, 1e6F, 0}, "VEC3")}}}});
    const auto [scene, warnings] = load(builder);
    CHECK(scene.cameras[0].eye == near.scene.cameras[0].eye);
    REQUIRE(warnings.size() == 1);
    CHECK(warnings[0].find("leaves out 1 triangles") != std::string::npos);
}

TEST_CASE("an automatic camera is as near to a scene of a micrometre, for its size, as to any other") {
    GltfBuilder builder;
    builder.place({{"attributes", {{"POSITION", builder.floats({0, 0, 0, 1e-6F, 0, 0, 0, 1e-6F, 0}, "VEC3")}}}});
    const Scene scene = load(builder).scene;
    CHECK(length(scene.frame.to_world(scene.cameras[0].eye)) < 1e-5);
}
