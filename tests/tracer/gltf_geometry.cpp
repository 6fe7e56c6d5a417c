#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "tests/tracer/gltf_files.hpp"

using namespace raycache;
using namespace raycache::tracer;
using namespace raycache::tracer::test;

namespace {

const std::vector<float> square{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};  // as a strip: two triangles facing +z

void check_near(Vec3 a, Vec3 b) {
    INFO(a.x << ' ' << a.y << ' ' << a.z << " against " << b.x << ' ' << b.y << ' ' << b.z);
    CHECK(length(a - b) < 1e-5F);
}

}  // namespace

TEST_CASE("a triangle without indices, normals or material gets face normals and the default material") {
    GltfBuilder builder;
    builder.place_triangle();
    const auto [scene, warnings] = load(builder);
    REQUIRE(scene.triangle_count() == 1);
    CHECK(scene.indices == std::vector<std::uint32_t>{0, 1, 2});
    CHECK(scene.positions == std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    CHECK(scene.normals.empty());
    CHECK(scene.texcoords.empty());
    REQUIRE(scene.materials.size() == 1);
    CHECK(scene.materials[0].base_color == Vec3{1, 1, 1});
    CHECK(scene.bounds() == Box{{0, 0, 0}, {1, 1, 0}});
    CHECK(scene.name == "scene.glb");
    CHECK(warnings.empty());
}

TEMPLATE_TEST_CASE("indices of every unsigned type are read", "", std::uint8_t, std::uint16_t, std::uint32_t) {
    GltfBuilder builder;
    const int type = sizeof(TestType) == 1 ? 5121 : sizeof(TestType) == 2 ? 5123 : 5125;
    const int indices = builder.accessor(std::vector<TestType>{2, 1, 3, 0, 1, 2}, "SCALAR", type);
    builder.place({{"attributes", {{"POSITION", builder.floats(square, "VEC3")}}}, {"indices", indices}});
    const Scene scene = load(builder).scene;
    CHECK(scene.indices == std::vector<std::uint32_t>{2, 1, 3, 0, 1, 2});
}

TEST_CASE("triangle strips and fans face the same way as their first triangle") {
    for (const int mode : {5, 6}) {
        GltfBuilder builder;
        const std::vector<float> round{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
        builder.place(
            {{"attributes", {{"POSITION", builder.floats(mode == 5 ? square : round, "VEC3")}}}, {"mode", mode}});
        const Scene scene = load(builder).scene;
        REQUIRE(scene.triangle_count() == 2);
        check_near(face_normal(scene, 0), {0, 0, 1});
        check_near(face_normal(scene, 1), {0, 0, 1});
    }
}

TEST_CASE("points and lines are skipped with one warning that counts them") {
    GltfBuilder builder;
    builder.place_triangle();
    for (const int mode : {0, 1, 3})
        builder.place({{"attributes", {{"POSITION", builder.triangle_positions()}}}, {"mode", mode}});
    const auto [scene, warnings] = load(builder);
    CHECK(scene.triangle_count() == 1);
    REQUIRE(warnings.size() == 1);
    CHECK(warnings[0].find("skipped 3 primitives made of points or lines") != std::string::npos);
}

TEST_CASE("children inherit translation, rotation and scale from their parents") {
    GltfBuilder builder;
    const int mesh = builder.mesh({{"attributes", {{"POSITION", builder.triangle_positions()}}}});
    const float half = std::sqrt(0.5F);
    builder.node({{"children", {1}}, {"translation", {10, 0, 0}}, {"rotation", {0, 0, half, half}}});  // 90° about z
    builder.node({{"mesh", mesh}, {"scale", {2, 3, 1}}, {"translation", {0, 1, 0}}});
    const Scene scene = load(builder).scene;
    REQUIRE(scene.triangle_count() == 1);
    check_near(corner(scene, 0, 0), {9, 0, 0});
    check_near(corner(scene, 0, 1), {9, 2, 0});
    check_near(corner(scene, 0, 2), {6, 0, 0});
}

TEST_CASE("a mesh placed twice is expanded twice, each with its own matrix") {
    GltfBuilder builder;
    const int mesh = builder.mesh({{"attributes", {{"POSITION", builder.triangle_positions()}}}});
    builder.node({{"mesh", mesh}});
    builder.node({{"mesh", mesh}, {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1}}});
    const Scene scene = load(builder).scene;
    REQUIRE(scene.triangle_count() == 2);
    check_near(corner(scene, 0, 1), {1, 0, 0});
    check_near(corner(scene, 1, 1), {6, 6, 7});
}

TEST_CASE("a mirroring matrix turns triangles round so that fronts and normals still agree") {
    GltfBuilder builder;
    const int normals = builder.floats({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
    const int mesh = builder.mesh({{"attributes", {{"POSITION", builder.triangle_positions()}, {"NORMAL", normals}}}});
    builder.node({{"mesh", mesh}, {"scale", {-1, 1, 1}}});
    builder.node({{"mesh", mesh}, {"scale", {1, 1, -2}}});
    const Scene scene = load(builder).scene;
    REQUIRE(scene.triangle_count() == 2);
    check_near(face_normal(scene, 0), {0, 0, 1});
    check_near(scene.normals[scene.indices[0]], {0, 0, 1});
    check_near(face_normal(scene, 1), {0, 0, -1});
    check_near(scene.normals[scene.indices[3]], {0, 0, -1});
}

TEST_CASE("normals follow the inverse transpose and come out unit") {
    GltfBuilder builder;
    const int normals = builder.floats({1, 1, 0, 1, 1, 0, 0, 0, 0}, "VEC3");
    const int mesh = builder.mesh({{"attributes", {{"POSITION", builder.triangle_positions()}, {"NORMAL", normals}}}});
    builder.node({{"mesh", mesh}, {"scale", {2, 1, 1}}});
    const Scene scene = load(builder).scene;
    check_near(scene.normals[0], normalize(Vec3{0.5F, 1, 0}));
    CHECK(scene.normals[2] == Vec3{0, 0, 0});
}

TEST_CASE("meshes with and without normals share one list in which (0,0,0) asks for the face normal") {
    GltfBuilder builder;
    builder.place_triangle();
    const int normals = builder.floats({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
    builder.place({{"attributes", {{"POSITION", builder.triangle_positions()}, {"NORMAL", normals}}}});
    const Scene scene = load(builder).scene;
    REQUIRE(scene.normals.size() == 6);
    CHECK(scene.normals[0] == Vec3{0, 0, 0});
    CHECK(scene.normals[3] == Vec3{0, 0, 1});
}

TEST_CASE("sparse accessors replace single elements, with or without a base") {
    GltfBuilder builder;
    const std::vector<std::uint16_t> where{1, 2};
    const std::vector<float> what{4, 0, 0, 0, 5, 0};
    const json sparse = {{"count", 2},
                         {"indices", {{"bufferView", builder.view(where.data(), 4)}, {"componentType", 5123}}},
                         {"values", {{"bufferView", builder.view(what.data(), 24)}}}};
    const int based = builder.triangle_positions();
    builder.doc["accessors"][static_cast<std::size_t>(based)]["sparse"] = sparse;
    const int unbased =
        builder.add("accessors", {{"componentType", 5126}, {"count", 3}, {"type", "VEC3"}, {"sparse", sparse}});
    builder.place({{"attributes", {{"POSITION", based}}}});
    builder.place({{"attributes", {{"POSITION", unbased}}}});
    const Scene scene = load(builder).scene;
    const std::vector<Vec3> expected{{0, 0, 0}, {4, 0, 0}, {0, 5, 0}, {0, 0, 0}, {4, 0, 0}, {0, 5, 0}};
    CHECK(scene.positions == expected);
}

TEST_CASE("interleaved vertices are read with their stride") {
    GltfBuilder builder;
    const std::vector<float> vertices{0, 0, 0, 9, 1, 0, 0, 9, 0, 1, 0, 9};
    const int view = builder.view(vertices.data(), 48, 16);
    const int positions =
        builder.add("accessors", {{"bufferView", view}, {"componentType", 5126}, {"count", 3}, {"type", "VEC3"}});
    builder.place({{"attributes", {{"POSITION", positions}}}});
    CHECK(load(builder).scene.positions == std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
}

TEST_CASE("quantised positions need no float") {
    GltfBuilder builder;
    builder.doc["extensionsRequired"] = builder.doc["extensionsUsed"] = {"KHR_mesh_quantization"};
    const std::vector<std::int16_t> plain{0, 0, 0, 0, -7, 0, 0, 0, 0, 9, 0, 0};
    const int view = builder.view(plain.data(), 24, 8);
    const int positions =
        builder.add("accessors", {{"bufferView", view}, {"componentType", 5122}, {"count", 3}, {"type", "VEC3"}});
    builder.place({{"attributes", {{"POSITION", positions}}}});
    const auto [scene, warnings] = load(builder);
    CHECK(scene.positions == std::vector<Vec3>{{0, 0, 0}, {-7, 0, 0}, {0, 9, 0}});
    REQUIRE(warnings.size() == 1);
    CHECK(warnings[0].find("1 triangles show a camera the back of an open, single-sided mesh") != std::string::npos);
}

TEST_CASE("triangles of no area are kept") {
    GltfBuilder builder;
    builder.place({{"attributes", {{"POSITION", builder.floats({1, 1, 1, 1, 1, 1, 1, 1, 1}, "VEC3")}}}});
    CHECK(error_of(builder).find("expected at least one triangle with an area, found 1 whose corners lie in a line") !=
          std::string::npos);
    builder.place_triangle();
    CHECK(load(builder).scene.triangle_count() == 2);
}

TEST_CASE("backs of open single-sided meshes that a camera sees are counted; closed and double-sided ones are not") {
    const auto warnings = [](bool back, bool double_sided, bool closed) {
        GltfBuilder builder;
        builder.add("materials", {{"doubleSided", double_sided}});
        std::vector<std::uint16_t> corners{0, 1, 2};
        if (back) corners = {0, 2, 1};
        if (closed) corners = {0, 1, 2, 0, 2, 1};
        builder.place({{"attributes", {{"POSITION", builder.triangle_positions()}}},
                       {"indices", builder.accessor(corners, "SCALAR", 5123)},
                       {"material", 0}});
        return load(builder).warnings;
    };
    CHECK(warnings(false, false, false).empty());
    CHECK(warnings(true, true, false).empty());
    CHECK(warnings(true, false, true).empty());
    REQUIRE(warnings(true, false, false).size() == 1);
    CHECK(warnings(true, false, false)[0].find("1 triangles show a camera the back") != std::string::npos);
}

TEST_CASE("corners that make no whole triangle are left out with a warning") {
    for (const auto& [mode, count, triangles] : {std::tuple{4, 5, 1}, std::tuple{4, 3, 1}, std::tuple{5, 2, 0},
                                                 std::tuple{6, 2, 0}, std::tuple{5, 4, 2}, std::tuple{4, 2, 0}}) {
        GltfBuilder builder;
        std::vector<std::uint16_t> corners{0, 1, 2, 0, 1};
        corners.resize(static_cast<std::size_t>(count));
        builder.place({{"attributes", {{"POSITION", builder.triangle_positions()}}},
                       {"indices", builder.accessor(corners, "SCALAR", 5123)},
                       {"mode", mode}});
        builder.place_triangle();
        const auto [scene, warnings] = load(builder);
        CHECK(scene.triangle_count() == static_cast<std::size_t>(triangles) + 1);
        const int spare = mode == 4 ? count % 3 : count < 3 ? count : 0;
        CHECK(warnings.size() == (spare == 0 ? 0U : 1U));
        if (spare > 0)
            CHECK(warnings[0].find(std::to_string(spare) + " indices or vertices at the end of primitives") !=
                  std::string::npos);
    }
}

TEST_CASE("indices may come from sparse values alone, without a buffer view") {
    GltfBuilder builder;
    const std::vector<std::uint8_t> where{1, 2};
    const std::vector<std::uint16_t> what{1, 2};
    json sparse = {{"componentType", 5123}, {"count", 3}, {"type", "SCALAR"}};
    sparse["sparse"] = {{"count", 2},
                        {"indices", {{"bufferView", builder.view(where.data(), 2)}, {"componentType", 5121}}},
                        {"values", {{"bufferView", builder.view(what.data(), 4)}}}};
    builder.place(
        {{"attributes", {{"POSITION", builder.triangle_positions()}}}, {"indices", builder.add("accessors", sparse)}});
    const auto [scene, warnings] = load(builder);
    CHECK(warnings.empty());
    CHECK(corner(scene, 0, 2) == Vec3{0, 1, 0});
}

TEST_CASE("triangles with a vertex that is not finite are skipped with one warning that counts them") {
    const float inf = std::numeric_limits<float>::infinity(), nan = std::nanf("");
    GltfBuilder builder;
    builder.place_triangle();
    for (const float bad : {inf, -inf, nan, 1e19F})
        builder.place({{"attributes", {{"POSITION", builder.floats({0, 0, 0, 1, bad, 0, 0, 1, 0}, "VEC3")}}}});
    const auto [scene, warnings] = load(builder);
    CHECK(scene.triangle_count() == 1);
    CHECK(scene.positions.size() == 3);
    REQUIRE(warnings.size() == 1);
    CHECK(warnings[0].find("skipped 4 triangles") != std::string::npos);
}

TEST_CASE("triangles that a transform sends to infinity are skipped, their finite neighbours stay") {
    GltfBuilder builder;
    const std::vector<float> points{0, 0, 0, 1, 0, 0, 0, 1, 0, 3e17F, 0, 0};
    const int normals = builder.floats({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
    const int indices = builder.accessor(std::vector<std::uint16_t>{0, 1, 2, 0, 3, 2}, "SCALAR", 5123);
    const int mesh = builder.mesh(
        {{"attributes", {{"POSITION", builder.floats(points, "VEC3")}, {"NORMAL", normals}}}, {"indices", indices}});
    builder.node({{"mesh", mesh}, {"scale", {-1, -1, -1}}});
    builder.node({{"mesh", mesh}, {"scale", {-10, 10, 10}}});
    const auto [scene, warnings] = load(builder);
    REQUIRE(scene.triangle_count() == 3);
    CHECK(corner(scene, 2, 1) == Vec3{0, 10, 0});
    CHECK(scene.normals.size() == scene.positions.size());
    check_near(face_normal(scene, 2), {0, 0, 1});
    REQUIRE(warnings.size() == 1);
    CHECK(warnings[0].find("skipped 1 triangles") != std::string::npos);
}

TEST_CASE("normals that are not finite become face normals, with one warning") {
    GltfBuilder builder;
    const int normals = builder.floats({std::nanf(""), 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
    builder.place({{"attributes", {{"POSITION", builder.triangle_positions()}, {"NORMAL", normals}}}});
    const auto [scene, warnings] = load(builder);
    CHECK(scene.normals[0] == Vec3{0, 0, 0});
    CHECK(scene.normals[1] == Vec3{0, 0, 1});
    CHECK(warnings.size() == 1);
}

TEST_CASE("vertices that no triangle uses are left out") {
    GltfBuilder builder;
    const int indices = builder.accessor(std::vector<std::uint8_t>{1, 2, 3}, "SCALAR", 5121);
    const std::vector<float> points{900, 0, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 900, 0, 0};
    builder.place({{"attributes", {{"POSITION", builder.floats(points, "VEC3")}}}, {"indices", indices}});
    const Scene scene = load(builder).scene;
    CHECK(scene.positions.size() == 3);
    CHECK(scene.bounds().upper == Vec3{1, 1, 0});
}

TEST_CASE("only the default scene is loaded, else the first, else every root") {
    GltfBuilder builder;
    const int mesh = builder.mesh({{"attributes", {{"POSITION", builder.triangle_positions()}}}});
    for (int i = 0; i < 3; ++i) builder.node({{"mesh", mesh}, {"translation", {i, 0, 0}}});
    CHECK(load(builder).scene.triangle_count() == 3);
    builder.doc["scenes"] = {{{"nodes", {1}}}, {{"nodes", {0, 2}}}};
    CHECK(load(builder).scene.triangle_count() == 1);
    builder.doc["scene"] = 1;
    CHECK(load(builder).scene.triangle_count() == 2);
}

TEST_CASE("a hierarchy of 20000 levels is walked") {
    GltfBuilder builder;
    const int mesh = builder.mesh({{"attributes", {{"POSITION", builder.triangle_positions()}}}});
    constexpr int depth = 20000;
    for (int i = 0; i < depth; ++i) builder.node({{"children", {i + 1}}, {"translation", {1, 0, 0}}});
    builder.node({{"mesh", mesh}});
    const Scene scene = load(builder).scene;
    CHECK(scene.frame.to_world(scene.positions[0]) == Vec3d(depth, 0, 0));
}
