#include <catch2/catch.hpp>

#include "tests/tracer/gltf_files.hpp"

using namespace raycache;
using namespace raycache::tracer;
using namespace raycache::tracer::test;

namespace {

/// An indexed triangle: bufferView and accessor 0 are positions, 1 are indices.
GltfBuilder indexed() {
    GltfBuilder builder;
    const int positions = builder.triangle_positions();
    const int indices = builder.accessor(std::vector<std::uint16_t>{0, 1, 2}, "SCALAR", 5123);
    builder.place({{"attributes", {{"POSITION", positions}}}, {"indices", indices}});
    return builder;
}

void check_error(const GltfBuilder& builder, const std::string& part) {
    const std::string message = error_of(builder);
    INFO(message);
    CHECK(message.find(part) != std::string::npos);
    CHECK(message.find('\n') == std::string::npos);
}

}  // namespace

TEST_CASE("accessors that reach beyond their buffer view are errors") {
    GltfBuilder builder = indexed();
    json& positions = builder.doc["accessors"][0];
    SECTION("too many elements") { positions["count"] = 4; }
    SECTION("more elements than any number of bytes") { positions["count"] = 0xFFFFFFFFFFFFFFFFULL; }
    SECTION("offset past the end") { positions["byteOffset"] = 1000; }
    SECTION("offset that would wrap") { positions["byteOffset"] = 0xFFFFFFFFFFFFFFF0ULL; }
    SECTION("stride past the end") { builder.doc["bufferViews"][0]["byteStride"] = 252; }
    check_error(builder, "accessor 0 (mesh 0 primitive 0 POSITION): expected elements within its buffer view");
}

TEST_CASE("buffer views that reach beyond their buffer are errors") {
    GltfBuilder builder = indexed();
    json& view = builder.doc["bufferViews"][0];
    SECTION("length") { view["byteLength"] = 1000; }
    SECTION("offset") { view["byteOffset"] = 1000; }
    SECTION("sum that would wrap") { view["byteOffset"] = 0xFFFFFFFFFFFFFFFCULL; }
    check_error(builder, "buffer view 0: expected");
}

TEST_CASE("accessors of the wrong kind are errors") {
    GltfBuilder builder = indexed();
    json& positions = builder.doc["accessors"][0];
    json& indices = builder.doc["accessors"][1];
    SECTION("positions of two numbers") { positions["type"] = "VEC2"; }
    SECTION("positions as matrices") { positions["type"] = "MAT3"; }
    SECTION("positions of doubles") { positions["componentType"] = 5130; }
    SECTION("float indices") { indices["componentType"] = 5126; }
    SECTION("signed indices") { indices["componentType"] = 5122; }
    SECTION("vector indices") { indices["type"] = "VEC2"; }
    SECTION("no such component type") { positions["componentType"] = 1; }
    SECTION("no such type") { positions["type"] = "VEC9"; }
    SECTION("stride below the element") { builder.doc["bufferViews"][0]["byteStride"] = 8; }
    SECTION("odd stride") { builder.doc["bufferViews"][0]["byteStride"] = 13; }
    SECTION("no buffer view and an enormous count") {
        positions.erase("bufferView");
        positions["count"] = 3000000000U;
    }
    check_error(builder, "scene.glb: ");
}

TEST_CASE("references to accessors and buffer views out of range are errors") {
    GltfBuilder builder = indexed();
    json& primitive = builder.doc["meshes"][0]["primitives"][0];
    SECTION("position accessor") { primitive["attributes"]["POSITION"] = 12; }
    SECTION("negative position accessor") { primitive["attributes"]["POSITION"] = -1; }
    SECTION("index accessor") { primitive["indices"] = 12; }
    SECTION("buffer view") { builder.doc["accessors"][0]["bufferView"] = 12; }
    SECTION("mode") { primitive["mode"] = 7; }
    SECTION("attributes missing") { primitive.erase("attributes"); }
    SECTION("attributes of the wrong type") { primitive["attributes"] = {1, 2}; }
    check_error(builder, "scene.glb: ");
}

TEST_CASE("an index beyond the vertices is an error that names both") {
    GltfBuilder builder = indexed();
    builder.bin[36] = 3;
    check_error(builder, "expected a vertex below 3, found 3");
}

TEST_CASE("attributes of different lengths are errors") {
    GltfBuilder builder = indexed();
    builder.doc["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = builder.floats({0, 0, 1}, "VEC3");
    check_error(builder, "expected 3 elements, as many as POSITION, found 1");
}

TEST_CASE("sparse accessors with bad indices, counts or views are errors") {
    GltfBuilder builder = indexed();
    const std::vector<std::uint8_t> where{1, 2, 0, 3};
    const std::vector<float> what(12, 1.0F);
    json sparse = {{"count", 2},
                   {"indices", {{"bufferView", builder.view(where.data(), 4)}, {"componentType", 5121}}},
                   {"values", {{"bufferView", builder.view(what.data(), 48)}}}};
    SECTION("decreasing") { sparse["count"] = 3; }
    SECTION("beyond the elements") {
        sparse["count"] = 1;
        sparse["indices"]["byteOffset"] = 3;
    }
    SECTION("more than elements") { sparse["count"] = 4; }
    SECTION("negative count") { sparse["count"] = -1; }
    SECTION("negative offset") { sparse["values"]["byteOffset"] = -4; }
    SECTION("offset past the end") { sparse["values"]["byteOffset"] = 40; }
    SECTION("no such view") { sparse["indices"]["bufferView"] = 77; }
    SECTION("float indices") { sparse["indices"]["componentType"] = 5126; }
    SECTION("no indices") { sparse.erase("indices"); }
    SECTION("not an object") { sparse = 7; }
    builder.doc["accessors"][0]["sparse"] = sparse;
    check_error(builder, "scene.glb: ");
}

TEST_CASE("node hierarchies with cycles, shared children or bad references are errors") {
    GltfBuilder builder = indexed();
    std::string part;
    SECTION("a cycle below a root") {
        builder.node({{"children", {2}}});
        builder.node({{"children", {3}}});
        builder.node({{"children", {2}}});
        builder.doc["scenes"] = {{{"nodes", {0, 1}}}};
        part = "node 2: expected one parent at most";
    }
    SECTION("a node that is its own child") {
        builder.doc["nodes"][0]["children"] = {0};
        part = "expected at least one triangle";  // no root reaches it
    }
    SECTION("two parents") {
        builder.node({{"children", {0}}});
        builder.node({{"children", {0}}});
        part = "node 0: expected one parent at most";
    }
    SECTION("no such child") {
        builder.doc["nodes"][0]["children"] = {9};
        part = "expected a node below 1, found 9";
    }
    SECTION("negative child") {
        builder.doc["nodes"][0]["children"] = {-1};
        part = "expected a node below 1, found -1";
    }
    SECTION("no such mesh") {
        builder.doc["nodes"][0]["mesh"] = 4;
        part = "expected a mesh below 1, found 4";
    }
    SECTION("no such scene") {
        builder.doc["scenes"] = {{{"nodes", {0}}}};
        builder.doc["scene"] = 2;
        part = "expected a scene below 1, found 2";
    }
    SECTION("no such camera") {
        builder.doc["nodes"][0]["camera"] = 0;
        part = "expected a camera below 0, found 0";
    }
    SECTION("matrix of nine numbers") {
        builder.doc["nodes"][0]["matrix"] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
        part = "nodes[0].matrix: expected 16 numbers, found [1";
    }
    SECTION("rotation of zero length") {
        builder.doc["nodes"][0]["rotation"] = {0, 0, 0, 0};
        part = "expected a unit quaternion, found all zeros";
    }
    check_error(builder, part);
}

TEST_CASE("a scene whose triangles all have bad vertices is an error after the warning") {
    GltfBuilder builder;
    builder.place({{"attributes", {{"POSITION", builder.floats({0, 0, 0, 1, 0, 0, 0, 1e30F, 0}, "VEC3")}}}});
    check_error(builder, "expected at least one triangle with finite vertices, found none");
}

TEST_CASE("more triangles than a trace can number are an error before any is made") {
    GltfBuilder builder;
    constexpr std::uint32_t corners = 3 * 60000;
    const std::vector<std::uint8_t> zeros(corners, 0);
    const int positions = builder.triangle_positions();
    const int indices = builder.accessor(zeros, "SCALAR", 5121);
    const int mesh = builder.mesh({{"attributes", {{"POSITION", positions}}}, {"indices", indices}});
    for (int i = 0; i < 18000; ++i) builder.node({{"mesh", mesh}});
    check_error(builder, "expected at most 1073741822 triangles, found more");
}

TEST_CASE("more materials than a triangle can number are an error") {
    GltfBuilder builder = indexed();
    builder.doc["materials"] = json(std::vector<json>(65536, json::object()));
    check_error(builder, "materials: expected at most 65535, found 65536");
}
