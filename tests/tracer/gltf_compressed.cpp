// Geometry compressed with Draco and meshoptimizer, by their own encoders: what comes out is what went in.
#include <draco/attributes/point_attribute.h>
#include <draco/compression/encode.h>
#include <draco/mesh/mesh.h>
#include <meshoptimizer.h>

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/tracer/pictures.hpp"
#include "tests/tracer/test_meshes.hpp"

using namespace raycache;
using namespace raycache::tracer;
using namespace raycache::tracer::test;

namespace {

const std::vector<float> flat(const std::vector<Vec3>& points) {
    std::vector<float> numbers;
    for (const Vec3 p : points) numbers.insert(numbers.end(), {p.x, p.y, p.z});
    return numbers;
}

/// A mesh as a Draco stream with attributes 0 (positions) and 1 (a number per vertex, in 8 bits, of four).
std::vector<char> draco_stream(const Scene& source, bool quantized) {
    draco::Mesh mesh;
    const auto points = static_cast<std::uint32_t>(source.positions.size());
    mesh.set_num_points(points);
    draco::GeometryAttribute position, color;
    position.Init(draco::GeometryAttribute::POSITION, nullptr, 3, draco::DT_FLOAT32, false, 12, 0);
    color.Init(draco::GeometryAttribute::COLOR, nullptr, 4, draco::DT_UINT8, true, 4, 0);
    const int p = mesh.AddAttribute(position, true, points), c = mesh.AddAttribute(color, true, points);
    for (std::uint32_t v = 0; v < points; ++v) {
        const float at[3] = {source.positions[v].x, source.positions[v].y, source.positions[v].z};
        const std::uint8_t rgba[4] = {static_cast<std::uint8_t>(v % 256), 7, 255, 255};
        mesh.attribute(p)->SetAttributeValue(draco::AttributeValueIndex(v), at);
        mesh.attribute(c)->SetAttributeValue(draco::AttributeValueIndex(v), rgba);
    }
    for (std::size_t t = 0; t < source.triangle_count(); ++t) {
        draco::Mesh::Face face;
        for (std::size_t k = 0; k < 3; ++k) face[k] = draco::PointIndex(source.indices[3 * t + k]);
        mesh.AddFace(face);
    }
    draco::Encoder encoder;
    if (quantized) encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, 14);
    encoder.SetEncodingMethod(quantized ? draco::MESH_EDGEBREAKER_ENCODING : draco::MESH_SEQUENTIAL_ENCODING);
    draco::EncoderBuffer buffer;
    REQUIRE(encoder.EncodeMeshToBuffer(mesh, &buffer).ok());
    return {buffer.data(), buffer.data() + buffer.size()};
}

GltfBuilder with_draco(const Scene& source, const std::vector<char>& stream) {
    GltfBuilder builder;
    const auto accessor = [&](const char* type, int component, std::size_t count) {
        return builder.add("accessors", {{"componentType", component}, {"count", count}, {"type", type}});
    };
    json primitive;
    primitive["attributes"]["POSITION"] = accessor("VEC3", 5126, source.positions.size());
    primitive["attributes"]["COLOR_0"] = accessor("VEC4", 5121, source.positions.size());
    builder.doc["accessors"][1]["normalized"] = true;
    primitive["indices"] = accessor("SCALAR", 5123, source.indices.size());
    primitive["extensions"]["KHR_draco_mesh_compression"] = {{"bufferView", builder.view(stream.data(), stream.size())},
                                                             {"attributes", {{"POSITION", 0}, {"COLOR_0", 1}}}};
    builder.place(primitive);
    builder.doc["extensionsUsed"] = builder.doc["extensionsRequired"] = {"KHR_draco_mesh_compression"};
    return builder;
}

/// Sum over triangles of something that no order of triangles changes, nor which corner of one comes first.
double signature(const Scene& scene) {
    double sum = 0;
    for (std::size_t t = 0; t < scene.triangle_count(); ++t) {
        const Vec3 a = corner(scene, t, 0), b = corner(scene, t, 1), c = corner(scene, t, 2);
        const Vec3 middle = a + b + c;
        sum += double{dot(cross(b - a, c - a), middle * 3.0F + Vec3{1, 2, 3})} *
               (1 + double{middle.x} + 2 * double{middle.y} * double{middle.z});
    }
    return sum;
}

GltfBuilder with_meshopt(const Scene& source, bool fallback) {
    GltfBuilder builder;
    const std::vector<float> numbers = flat(source.positions);
    const std::size_t vertices = source.positions.size(), indices = source.indices.size();
    std::vector<unsigned char> packed(meshopt_encodeVertexBufferBound(vertices, 12));
    packed.resize(meshopt_encodeVertexBuffer(packed.data(), packed.size(), numbers.data(), vertices, 12));
    std::vector<unsigned char> packed_indices(meshopt_encodeIndexBufferBound(indices, vertices));
    packed_indices.resize(
        meshopt_encodeIndexBuffer(packed_indices.data(), packed_indices.size(), source.indices.data(), indices));
    const auto view = [&](const std::vector<unsigned char>& bytes, std::size_t count, std::size_t stride,
                          const char* mode) {
        const int v = builder.view(bytes.data(), bytes.size());
        json& description = builder.doc["bufferViews"][static_cast<std::size_t>(v)];
        const json packed_view = {{"buffer", 0},
                                  {"byteOffset", description["byteOffset"]},
                                  {"byteLength", bytes.size()},
                                  {"byteStride", stride},
                                  {"count", count},
                                  {"mode", mode}};
        description = {{"buffer", 1}, {"byteOffset", 0}, {"byteLength", count * stride}};
        if (std::string(mode) == "ATTRIBUTES") description["byteStride"] = stride;
        description["extensions"]["EXT_meshopt_compression"] = packed_view;
        return v;
    };
    const int positions = view(packed, vertices, 12, "ATTRIBUTES");
    const int corners = view(packed_indices, indices, 4, "TRIANGLES");
    json primitive;
    primitive["attributes"]["POSITION"] = builder.add(
        "accessors", {{"bufferView", positions}, {"componentType", 5126}, {"count", vertices}, {"type", "VEC3"}});
    primitive["indices"] = builder.add(
        "accessors", {{"bufferView", corners}, {"componentType", 5125}, {"count", indices}, {"type", "SCALAR"}});
    builder.place(primitive);
    builder.doc["extensionsUsed"] = {"EXT_meshopt_compression"};
    if (!fallback) builder.doc["extensionsRequired"] = {"EXT_meshopt_compression"};
    return builder;
}

/// As a .gltf, whose second buffer stands for nothing.
std::string text_of(const GltfBuilder& builder) {
    json document = builder.finished("data:application/octet-stream;base64," + base64(builder.bin));
    document["buffers"].push_back(
        {{"byteLength", 1 << 20}, {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}});
    return document.dump();
}

}  // namespace

TEST_CASE("a mesh compressed with Draco is what its encoder was given") {
    const Scene source = icosphere(3);
    for (const bool quantized : {false, true}) {
        const auto [scene, warnings] = load(with_draco(source, draco_stream(source, quantized)));
        CHECK(warnings.empty());
        REQUIRE(scene.triangle_count() == source.triangle_count());
        CHECK(signature(scene) == Approx(signature(source)).epsilon(quantized ? 1e-3 : 1e-6));
        REQUIRE(scene.colors.size() == scene.positions.size());
        for (std::size_t v = 0; v < scene.positions.size(); ++v) {
            CHECK(length(scene.positions[v]) == Approx(1).epsilon(quantized ? 1e-3 : 1e-6));
            CHECK(scene.colors[v].color.y == Approx(7.0 / 255));
            CHECK(scene.colors[v].color.z == 1);
        }
    }
}

TEST_CASE("a Draco stream that is none, cut short or without an attribute is an error that speaks of Draco") {
    const Scene source = icosphere(1);
    const auto stream = draco_stream(source, true);
    const auto error = [&](const std::vector<char>& bytes) { return error_of(with_draco(source, bytes)); };
    CHECK(error(std::vector<char>(40, 'x')).find("mesh 0 primitive 0: expected a mesh compressed with Draco") !=
          std::string::npos);
    for (std::size_t size = 1; size < stream.size(); size += 7) {
        const std::string message = error({stream.begin(), stream.begin() + static_cast<long>(size)});
        INFO(message);
        CHECK(message.find("Draco") != std::string::npos);
        CHECK(message.find("gltf-transform") != std::string::npos);
    }
    GltfBuilder other = with_draco(source, stream);
    other.doc["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"]["attributes"]["COLOR_0"] = 9;
    CHECK(error_of(other).find("COLOR_0: expected attribute 9 of the Draco stream, found none") != std::string::npos);
}

TEST_CASE("buffer views compressed with meshoptimizer are what its encoder was given") {
    Scene source = icosphere(3);
    const TempFolder folder;
    for (const bool fallback : {false, true}) {
        const auto [scene, warnings] = load_file(folder.write("a.gltf", text_of(with_meshopt(source, fallback))));
        CHECK(warnings.empty());
        REQUIRE(scene.triangle_count() == source.triangle_count());
        CHECK(signature(scene) == Approx(signature(source)).epsilon(1e-6));
    }
}

TEST_CASE("filters of meshoptimizer are undone") {
    const std::vector<Vec3> normals{{0, 0, 1}, {0.6F, 0, 0.8F}, {-0.36F, 0.48F, -0.8F}};
    std::vector<float> four;
    for (const Vec3 n : normals) four.insert(four.end(), {n.x, n.y, n.z, 0});
    std::vector<std::int8_t> filtered(12);
    meshopt_encodeFilterOct(filtered.data(), 3, 4, 8, four.data());
    GltfBuilder builder;
    std::vector<unsigned char> packed(meshopt_encodeVertexBufferBound(3, 4));
    packed.resize(meshopt_encodeVertexBuffer(packed.data(), packed.size(), filtered.data(), 3, 4));
    const int positions = builder.triangle_positions();
    const int v = builder.view(packed.data(), packed.size());
    json& view = builder.doc["bufferViews"][static_cast<std::size_t>(v)];
    const json description = {{"buffer", 0},
                              {"byteOffset", view["byteOffset"]},
                              {"byteLength", packed.size()},
                              {"byteStride", 4},
                              {"count", 3},
                              {"mode", "ATTRIBUTES"},
                              {"filter", "OCTAHEDRAL"}};
    view = {{"buffer", 1},
            {"byteLength", 12},
            {"byteStride", 4},
            {"extensions", {{"EXT_meshopt_compression", description}}}};
    builder.place({{"attributes",
                    {{"POSITION", positions},
                     {"NORMAL", builder.add("accessors", {{"bufferView", v},
                                                          {"componentType", 5120},
                                                          {"normalized", true},
                                                          {"count", 3},
                                                          {"type", "VEC3"}})}}}});
    const TempFolder folder;
    const Scene scene = load_file(folder.write("a.gltf", text_of(builder))).scene;
    for (std::size_t i = 0; i < 3; ++i) CHECK(length(scene.normals[i] - normals[i]) < 0.02F);
}

TEST_CASE("a meshoptimizer stream that is none, cut short or too large is an error of one line") {
    const Scene source = icosphere(2);
    const TempFolder folder;
    const auto error = [&](const char* member, const json& value) {
        GltfBuilder builder = with_meshopt(source, false);
        builder.doc["bufferViews"][0]["extensions"]["EXT_meshopt_compression"][member] = value;
        return error_of(folder.write("a.gltf", text_of(builder)));
    };
    const auto mentions = [](const std::string& message, const std::string& part) {
        INFO(message);
        CHECK(message.find('\n') == std::string::npos);
        return message.find(part) != std::string::npos;
    };
    const std::string place = "bufferViews[0].extensions.EXT_meshopt_compression";
    CHECK(mentions(error("byteLength", 100), place + ": expected a stream of mode ATTRIBUTES"));
    CHECK(mentions(error("byteOffset", 4), place));
    CHECK(mentions(error("mode", "TRIANGLES"), place));
    CHECK(mentions(error("mode", "ZIP"), place + ".mode: expected ATTRIBUTES, TRIANGLES, INDICES, found \"ZIP\""));
    CHECK(mentions(error("count", 1e15), place + ".count: expected at most"));
    CHECK(mentions(error("byteStride", 3), place + ".byteStride: expected a multiple of 4"));
    CHECK(mentions(error("byteLength", 1e15), place + ": expected bytes within"));
    CHECK(mentions(error("buffer", 9), place + ".buffer: expected a buffer below 2, found 9"));
}
