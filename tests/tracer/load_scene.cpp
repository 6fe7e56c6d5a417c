#include <catch2/catch.hpp>
#include <limits>

#include "tests/tracer/gltf_files.hpp"

using namespace raycache;
using namespace raycache::tracer;
using namespace raycache::tracer::test;

namespace {

/// A triangle with two cameras, "near" and "far"; lit by itself if `emissive`, of no area if `flat`.
GltfBuilder room(bool emissive = false, bool flat = false) {
    GltfBuilder builder;
    const int corners = flat ? builder.floats({0, 0, 0, 1, 0, 0, 2, 0, 0}, "VEC3") : builder.triangle_positions();
    builder.add("materials", {{"emissiveFactor", {emissive ? 1 : 0, 0, 0}}});
    builder.place({{"attributes", {{"POSITION", corners}}}, {"material", 0}});
    if (flat) builder.place_triangle();
    const json camera = {{"type", "perspective"}, {"perspective", {{"yfov", 1.0}, {"znear", 0.1}}}};
    builder.node({{"name", "near"}, {"camera", builder.add("cameras", camera)}, {"translation", {0, 0, 2}}});
    builder.node({{"name", "far"}, {"camera", builder.add("cameras", camera)}, {"translation", {0, 0, 9}}});
    return builder;
}

Loaded load_with(SceneRequest request, const GltfBuilder& builder = room()) {
    const TempFolder folder;
    request.source = folder.write("room.glb", builder.glb());
    Loaded result;
    result.scene = load_scene(request, [&](const std::string& warning) { result.warnings.push_back(warning); });
    return result;
}

std::string usage_error(SceneRequest request, bool own_source = false) {
    try {
        own_source ? load_scene(request, nullptr) : load_with(request).scene;
    } catch (const UsageError& e) {
        CHECK(std::string(e.what()).find('\n') == std::string::npos);
        return e.what();
    }
    return "(no usage error)";
}

bool mentions(const std::string& message, const std::string& part) {
    INFO(message);
    return message.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("the first camera of a file is the default, another can be chosen by name or index") {
    CHECK(load_with({}).scene.cameras[0].name == "near");
    for (const char* choice : {"far", "1"}) {
        SceneRequest request;
        request.camera = choice;
        const Scene scene = load_with(request).scene;
        REQUIRE(scene.cameras.size() == 2);
        CHECK(scene.cameras[0].name == "far");
        CHECK(scene.cameras[1].name == "near");
    }
}

TEST_CASE("an unknown camera is a usage error that lists the cameras") {
    for (const char* choice : {"Far", "2", "-1", "1x", "99999999999999999999999"}) {
        SceneRequest request;
        request.camera = choice;
        CHECK(mentions(usage_error(request), "(near, far, or 0 to 1)"));
    }
}

TEST_CASE("eye and look-at replace the camera, its field of view stays unless given") {
    SceneRequest request;
    request.eye = Vec3{1, 2, 3};
    request.look_at = Vec3{1, 2, -7};
    const Camera kept = load_with(request).scene.cameras[0];
    CHECK(kept.eye == Vec3{1, 2, 3});
    CHECK(kept.forward == Vec3{0, 0, -1});
    CHECK(kept.up == Vec3{0, 1, 0});
    CHECK(kept.vertical_fov == Approx(57.29578));
    request.vertical_fov = 30.0F;
    request.look_at = Vec3{1, 500, 3};  // straight up
    const Camera upward = load_with(request).scene.cameras[0];
    CHECK(upward.vertical_fov == 30);
    CHECK(upward.forward == Vec3{0, 1, 0});
    CHECK(std::abs(dot(upward.forward, upward.up)) < 1e-6F);
    CHECK(length(upward.up) == Approx(1));
    CHECK(load_with(request).scene.cameras.size() == 3);
}

TEST_CASE("cameras that make no picture are usage errors") {
    const float inf = std::numeric_limits<float>::infinity(), nan = std::nanf("");
    SceneRequest request;
    request.eye = Vec3{1, 2, 3};
    CHECK(mentions(usage_error(request), "found only an eye"));
    request.look_at = request.eye;
    CHECK(mentions(usage_error(request), "found both at 1,2,3"));
    request.look_at = Vec3{inf, 0, 0};
    CHECK(mentions(usage_error(request), "finite numbers"));
    request.look_at = Vec3{0, nan, 0};
    CHECK(mentions(usage_error(request), "finite numbers"));
    request.eye.reset();
    CHECK(mentions(usage_error(request), "found only a look-at point"));
    for (const float fov : {0.0F, -5.0F, 180.0F, 1e9F, nan, inf}) {
        SceneRequest with_fov;
        with_fov.vertical_fov = fov;
        CHECK(mentions(usage_error(with_fov), "above 0 and below 180"));
    }
}

TEST_CASE("an eye or a look-at point beyond the limit of vertices is a usage error, one at it is not") {
    for (const float far : {1.001e18F, -2e18F, 1e19F, 1e30F, 3e38F}) {
        SceneRequest request;
        request.eye = Vec3{0, far, 0};
        request.look_at = Vec3{0, 0, 0};
        CHECK(mentions(usage_error(request), "--eye 0,"));
        std::swap(request.eye, request.look_at);
        CHECK(mentions(usage_error(request), "--look-at 0,"));
    }
    SceneRequest request;
    request.eye = Vec3{1e18F, 0, 0};
    request.look_at = Vec3{-1e18F, 0, 0};
    CHECK(load_with(request).scene.cameras[0].forward == Vec3{-1, 0, 0});
}

TEST_CASE("a camera of the file beyond the limit is refused where it is chosen, and only there") {
    GltfBuilder builder = room();
    builder.node({{"name", "beyond"}, {"camera", 0}, {"translation", {1e30, 3, 0}}});
    SceneRequest request;
    CHECK(load_with(request, builder).scene.cameras[0].name == "near");
    request.camera = "beyond";
    const std::string message = [&]() -> std::string {
        try {
            load_with(request, builder);
        } catch (const Error& e) {
            return dynamic_cast<const UsageError*>(&e) ? "a usage error" : e.what();
        }
        return "(no error)";
    }();
    CHECK(mentions(message, "room.glb: camera beyond: expected an eye within 1e+18 m"));
    request.eye = Vec3{1, 2, 3};
    request.look_at = Vec3{0, 0, 0};
    CHECK(load_with(request, builder).scene.cameras[0].eye == Vec3{1, 2, 3});
}

TEST_CASE("a file without a light gets a sky and a sun, and a warning says so") {
    const auto [scene, warnings] = load_with({});
    CHECK(luminance(scene.sky) > 0);
    REQUIRE(scene.sun);
    CHECK(length(scene.sun->direction) == Approx(1));
    CHECK(luminance(scene.sun->irradiance) > 0);
    REQUIRE(warnings.size() == 1);
    CHECK(mentions(warnings[0], "a sky and a sun are added"));
}

TEST_CASE("a file with a light of its own gets no sky unless asked, and then no second sun") {
    SceneRequest request;
    const auto [scene, warnings] = load_with(request, room(true));
    CHECK(scene.sky == Vec3{0, 0, 0});
    CHECK_FALSE(scene.sun);
    CHECK(warnings.empty());
    request.sky = SceneRequest::Sky::on;
    const auto [outdoors, more] = load_with(request, room(true));
    CHECK(luminance(outdoors.sky) > 0);
    CHECK_FALSE(outdoors.sun);
    CHECK(more.empty());
}

TEST_CASE("an emissive triangle of no area is no light") {
    CHECK(load_with({}, room(true, true)).scene.sun);
    GltfBuilder unused_emitter = room();
    unused_emitter.add("materials", {{"emissiveFactor", {1, 1, 1}}});
    CHECK(load_with({}, unused_emitter).scene.sun);
}

TEST_CASE("the sky can be left off") {
    SceneRequest request;
    request.sky = SceneRequest::Sky::off;
    const auto [scene, warnings] = load_with(request);
    CHECK(scene.sky == Vec3{0, 0, 0});
    CHECK_FALSE(scene.sun);
    CHECK(warnings.empty());
    request.sky = SceneRequest::Sky::on;
    const auto [lit, silent] = load_with(request);
    CHECK(lit.sun);
    CHECK(silent.empty());
}

TEST_CASE("a source that is neither a file nor a built-in scene is a usage error that lists the latter") {
    SceneRequest request;
    request.source = "no such\nscene";
    const std::string message = usage_error(request, true);
    CHECK(mentions(message, "the file does not exist"));
    for (const BuiltinScene& builtin : builtin_scenes()) CHECK(mentions(message, builtin.name));
}

TEST_CASE("a detail is refused for a file and outside a built-in scene's range") {
    SceneRequest request;
    request.detail = 1000;
    CHECK(mentions(usage_error(request), "only built-in scenes"));
    for (const BuiltinScene& builtin : builtin_scenes()) {
        request.source = builtin.name;
        request.detail = builtin.max_detail + 1;
        CHECK(mentions(usage_error(request, true), "expected a detail from"));
        if (builtin.min_detail < 2) continue;
        request.detail = builtin.min_detail - 1;
        CHECK(mentions(usage_error(request, true), "expected a detail from"));
    }
}

TEST_CASE("a built-in scene keeps its own light unless the sky is off") {
    for (const BuiltinScene& builtin : builtin_scenes()) {
        SceneRequest request;
        request.source = builtin.name;
        request.detail = builtin.min_detail;
        const Scene own = builtin.build(builtin.min_detail);
        const Scene scene = load_scene(request, nullptr);
        CHECK(scene.triangle_count() == own.triangle_count());
        CHECK(scene.sky == own.sky);
        CHECK(scene.sun.has_value() == own.sun.has_value());
        request.sky = SceneRequest::Sky::off;
        const Scene dark = load_scene(request, nullptr);
        CHECK(dark.sky == Vec3{0, 0, 0});
        CHECK_FALSE(dark.sun);
    }
}
