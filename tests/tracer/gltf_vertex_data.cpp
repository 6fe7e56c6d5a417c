// Colours of vertices, morph targets and skins at rest, and where instances, hidden nodes and lights stand.
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/tracer/pictures.hpp"
#include "tracer/paths/lights.hpp"

using namespace raycache;
using namespace raycache::tracer;
using namespace raycache::tracer::test;

namespace {

bool mentions(const std::vector<std::string>& warnings, const std::string& part) {
    for (const std::string& w : warnings)
        if (w.find(part) != std::string::npos) return true;
    return false;
}

Vec3 seen(const GltfBuilder& file) {
    Scene scene = load(file).scene;
    scene.sky = {1, 1, 1};
    return mean(picture(std::move(scene), 8, 16, {1}));
}

/// A triangle bound to two joints, which stand at (10,0,0) and (0,20,0) and bring vertices there.
GltfBuilder skinned(const std::vector<float>& weights, const std::vector<std::uint8_t>& joints) {
    GltfBuilder builder;
    const int mesh = builder.mesh({{"attributes",
                                    {{"POSITION", builder.triangle_positions()},
                                     {"NORMAL", builder.floats({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3")},
                                     {"JOINTS_0", builder.accessor(joints, "VEC4", 5121)},
                                     {"WEIGHTS_0", builder.floats(weights, "VEC4")}}}});
    builder.node({{"mesh", mesh}, {"skin", 0}, {"translation", {500, 0, 0}}});
    builder.node({{"translation", {10, 0, 0}}, {"children", {2}}});
    builder.node({{"translation", {-10, 20, 0}}});
    builder.doc["skins"] = {{{"joints", {1, 2}}}};
    builder.doc["scenes"] = {{{"nodes", {0, 1}}}};
    return builder;
}

}  // namespace

TEST_CASE("colours of vertices multiply the base colour, whatever type they are stored in") {
    std::vector<Vec3> found;
    for (int kind = 0; kind < 4; ++kind) {
        SquareFile file(grey(0.5));
        auto& color = file.primitive["attributes"]["COLOR_0"];
        if (kind == 0) color = file.floats({1, 0, 0.2F, 1, 0, 0.2F, 1, 0, 0.2F, 1, 0, 0.2F}, "VEC3");
        if (kind == 1) {
            std::vector<float> rgba;
            for (int i = 0; i < 4; ++i) rgba.insert(rgba.end(), {1, 0, 0.2F, 0.3F});
            color = file.floats(rgba, "VEC4");
        }
        if (kind == 2) {
            std::vector<std::uint8_t> rgba;
            for (int i = 0; i < 4; ++i) rgba.insert(rgba.end(), {255, 0, 51, 255});
            color = file.accessor(rgba, "VEC4", 5121, true);
        }
        if (kind == 3) {
            std::vector<std::uint16_t> rgba;
            for (int i = 0; i < 4; ++i) rgba.insert(rgba.end(), {65535, 0, 13107, 65535});
            color = file.accessor(rgba, "VEC4", 5123, true);
        }
        const auto [scene, warnings] = load(file.finish());
        CHECK(warnings.empty());
        REQUIRE(scene.colors.size() == 4);
        const VertexColor c = vertex_color_at(scene, 0, 0.3F, 0.3F);
        CHECK(c.color.x == Approx(1));
        CHECK(c.color.y == 0);
        CHECK(c.color.z == Approx(0.2));
    }
    SquareFile file(grey(0.5));
    file.primitive["attributes"]["COLOR_0"] = file.floats({1, 0, 0.2F, 1, 0, 0.2F, 1, 0, 0.2F, 1, 0, 0.2F}, "VEC3");
    const Vec3 red = seen(file.finish()), plain = seen(SquareFile(grey(0.5)).finish());
    CHECK(plain.x == Approx(0.5).epsilon(0.1));
    CHECK(red.x == Approx(plain.x));
    CHECK(red.y == Approx(plain.y - 0.5F).margin(0.06));
}

TEST_CASE("white colours are not kept, colours beyond 0 to 1 become the nearest, with a warning") {
    SquareFile white(grey());
    white.primitive["attributes"]["COLOR_0"] = white.floats(std::vector<float>(12, 1), "VEC3");
    CHECK(load(white.finish()).scene.colors.empty());
    SquareFile bright(grey());
    bright.primitive["attributes"]["COLOR_0"] = bright.floats({2, 0, 0, 1, 1, 1, -1, 1, 1, 1, 1, 1}, "VEC3");
    const auto [scene, warnings] = load(bright.finish());
    CHECK(scene.colors[0].color == Vec3{1, 0, 0});
    CHECK(mentions(warnings, "2 colours of vertices are beyond 0 to 1"));
}

TEST_CASE("the alpha of vertices cuts holes under MASK, lets rays pass under BLEND, and counts for nothing else") {
    for (const char* mode : {"OPAQUE", "MASK", "BLEND"}) {
        json material = grey();
        material["alphaMode"] = mode;
        SquareFile file(material);
        std::vector<float> rgba;
        for (int i = 0; i < 4; ++i) rgba.insert(rgba.end(), {1, 1, 1, i == 0 || i == 3 ? 0.0F : 1.0F});
        file.primitive["attributes"]["COLOR_0"] = file.floats(rgba, "VEC4");
        Scene scene = load(file.finish()).scene;
        const std::string name = mode;
        CHECK(scene.materials[0].may_have_holes() == (name == "MASK"));
        CHECK(scene.materials[0].alpha_blend == (name == "BLEND"));
        scene.sky = {1, 1, 1};
        const auto pixels = picture(std::move(scene), 16, 64, {0});
        const float left = pixels[8 * 16 + 2].x, right = pixels[8 * 16 + 13].x;
        // One bounce away from the sky: a surface is black with no bounces, a hole shows the sky.
        if (name == "OPAQUE") CHECK(left == 0);
        if (name == "MASK") CHECK(left == 1);
        if (name != "BLEND") CHECK(right == 0);
    }
}

TEST_CASE("morph targets move positions and normals by the weights of the mesh, or of the node") {
    GltfBuilder builder;
    const json primitive = {
        {"attributes",
         {{"POSITION", builder.triangle_positions()}, {"NORMAL", builder.floats({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3")}}},
        {"targets",
         {{{"POSITION", builder.floats({0, 5, 0, 0, 5, 0, 0, 5, 0}, "VEC3")},
           {"NORMAL", builder.floats({0, 3, -1, 0, 3, -1, 0, 3, -1}, "VEC3")}},
          {{"POSITION", builder.floats({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3")}}}}};
    const int mesh = builder.mesh(primitive);
    builder.doc["meshes"][0]["weights"] = {1.0, 0.5};
    builder.node({{"mesh", mesh}});
    builder.node({{"mesh", mesh}, {"weights", {0.0, -2.0}}});
    builder.node({{"mesh", mesh}});
    const auto [scene, warnings] = load(builder);
    CHECK(warnings.empty());
    REQUIRE(scene.triangle_count() == 3);
    CHECK(corner(scene, 0, 0) == Vec3{0, 5, 0.5F});
    CHECK(corner(scene, 1, 0) == Vec3{0, 0, -2});
    CHECK(corner(scene, 2, 1) == Vec3{1, 5, 0.5F});
    CHECK(scene.normals[0] == Vec3{0, 1, 0});
    CHECK(scene.normals[3] == Vec3{0, 0, 1});
}

TEST_CASE("a morph target may be sparse alone, and one of other attributes is a warning") {
    GltfBuilder builder;
    const std::uint8_t where = 1;
    const std::vector<float> what{0, 0, 7};
    json sparse = {{"componentType", 5126}, {"count", 3}, {"type", "VEC3"}};
    sparse["sparse"] = {{"count", 1},
                        {"indices", {{"bufferView", builder.view(&where, 1)}, {"componentType", 5121}}},
                        {"values", {{"bufferView", builder.view(what.data(), 12)}}}};
    const int mesh = builder.mesh(
        {{"attributes", {{"POSITION", builder.triangle_positions()}}},
         {"targets", {{{"POSITION", builder.add("accessors", sparse)}, {"COLOR_0", builder.triangle_positions()}}}}});
    builder.doc["meshes"][0]["weights"] = {1.0};
    builder.node({{"mesh", mesh}});
    const auto [scene, warnings] = load(builder);
    CHECK(corner(scene, 0, 0) == Vec3{0, 0, 0});
    CHECK(corner(scene, 0, 1) == Vec3{1, 0, 7});
    CHECK(mentions(warnings, "1 morph targets of attributes other than POSITION and NORMAL"));
    builder.doc["meshes"][0]["primitives"][0]["targets"][0]["POSITION"] = builder.floats({0, 0, 0}, "VEC3");
    CHECK(error_of(builder).find("target 0 POSITION: expected 3 elements, as many as POSITION, found 1") !=
          std::string::npos);
}

TEST_CASE("a skinned mesh stands where its joints are, not where its node is") {
    const std::vector<std::uint8_t> joints{0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0};
    const auto [scene, warnings] = load(skinned({1, 0, 0, 0, 0, 1, 0, 0, 1, 1, 0, 0}, joints));
    CHECK(warnings.empty());
    CHECK(corner(scene, 0, 0) == Vec3{10, 0, 0});
    CHECK(corner(scene, 0, 1) == Vec3{1, 20, 0});
    CHECK(corner(scene, 0, 2) == Vec3{5, 11, 0});  // half of each: weights add up to 2
    GltfBuilder bound = skinned({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, joints);
    std::vector<float> matrices(32, 0);
    for (std::size_t m = 0; m < 2; ++m)
        for (std::size_t k = 0; k < 4; ++k) matrices[16 * m + 5 * k] = 1;
    matrices[12] = -3;  // first column of the last row of the first: its x
    bound.doc["skins"][0]["inverseBindMatrices"] = bound.accessor(matrices, "VEC4", 5126);
    json& accessor = bound.doc["accessors"].back();
    accessor["type"] = "MAT4";
    accessor["count"] = 2;
    CHECK(corner(load(bound).scene, 0, 0) == Vec3{7, 0, 0});
    accessor["count"] = 1;
    CHECK(error_of(bound).find("expected 2 matrices, one per joint, found 1") != std::string::npos);
}

TEST_CASE("a joint that a skin does not have is an error; a mesh without joints stands where its node is") {
    const std::vector<std::uint8_t> joints{0, 1, 0, 0, 7, 1, 0, 0, 0, 1, 0, 0};
    CHECK(error_of(skinned({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, joints)).find("expected joints below 2, found 7") !=
          std::string::npos);
    GltfBuilder plain = skinned({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, std::vector<std::uint8_t>(12, 0));
    plain.doc["meshes"][0]["primitives"][0]["attributes"].erase("JOINTS_0");
    const Scene scene = load(plain).scene;  // centred on it
    CHECK(scene.frame.to_world(Vec3d(corner(scene, 0, 0))).rounded() == Vec3{500, 0, 0});
}

TEST_CASE("instances of a mesh stand where their attributes say, within their node") {
    GltfBuilder builder;
    const int mesh = builder.mesh({{"attributes", {{"POSITION", builder.triangle_positions()}}}});
    const int places = builder.floats({1, 0, 0, 0, 2, 0}, "VEC3");
    const int turns = builder.accessor(std::vector<std::int16_t>{0, 0, 32767, 0, 0, 0, 0, 32767}, "VEC4", 5122, true);
    const int sizes = builder.floats({2, 2, 2, 1, 1, 3}, "VEC3");
    builder.node({{"mesh", mesh},
                  {"translation", {100, 0, 0}},
                  {"extensions",
                   {{"EXT_mesh_gpu_instancing",
                     {{"attributes", {{"TRANSLATION", places}, {"ROTATION", turns}, {"SCALE", sizes}}}}}}}});
    builder.doc["extensionsUsed"] = builder.doc["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
    const auto [scene, warnings] = load(builder);
    CHECK(warnings.empty());
    REQUIRE(scene.triangle_count() == 2);
    CHECK(corner(scene, 0, 0) == Vec3{101, 0, 0});
    CHECK(length(corner(scene, 0, 1) - Vec3{99, 0, 0}) < 1e-4F);  // half a turn about z, twice as large
    CHECK(corner(scene, 1, 1) == Vec3{101, 2, 0});
    auto& attributes = builder.doc["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
    attributes["SCALE"] = builder.floats({1, 1, 1}, "VEC3");
    CHECK(error_of(builder).find("as many as the others") != std::string::npos);
    attributes = {{"_ID", sizes}};
    CHECK(error_of(builder).find("expected TRANSLATION, ROTATION or SCALE, found none of them") != std::string::npos);
}

TEST_CASE("a node that is not visible hides what hangs on it, but for cameras") {
    GltfBuilder builder;
    const int mesh = builder.mesh({{"attributes", {{"POSITION", builder.triangle_positions()}}}});
    builder.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 1.0}, {"znear", 0.1}}}});
    builder.node({{"children", {1, 2}}, {"extensions", {{"KHR_node_visibility", {{"visible", false}}}}}});
    builder.node({{"mesh", mesh}, {"extensions", {{"KHR_node_visibility", {{"visible", true}}}}}});
    builder.node({{"camera", 0}, {"name", "eye"}});
    builder.node(
        {{"mesh", mesh}, {"translation", {0, 0, 5}}, {"extensions", {{"KHR_node_visibility", json::object()}}}});
    builder.doc["scenes"] = {{{"nodes", {0, 3}}}};
    builder.doc["extensionsUsed"] = {"KHR_node_visibility"};
    const auto [scene, warnings] = load(builder);
    CHECK(scene.triangle_count() == 1);
    CHECK(corner(scene, 0, 0) == Vec3{0, 0, 5});
    CHECK(scene.cameras[0].name == "eye");
    CHECK(warnings.empty());
}
