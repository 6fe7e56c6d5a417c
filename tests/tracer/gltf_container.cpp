#include <catch2/catch.hpp>

#include "tests/tracer/gltf_files.hpp"

using namespace raycache;
using namespace raycache::tracer;
using namespace raycache::tracer::test;

namespace {

GltfBuilder simple() {
    GltfBuilder builder;
    builder.place_triangle();
    return builder;
}

bool mentions(const std::string& message, const std::string& part) {
    INFO(message);
    CHECK(message.find('\n') == std::string::npos);
    return message.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("the same scene loads from a .glb, a .gltf with a data: URI and a .gltf with an external buffer") {
    const TempFolder folder;
    const GltfBuilder builder = simple();
    folder.write("my data.bin", builder.bin);
    for (const std::string& path :
         {folder.write("a.glb", builder.glb()), folder.write("b.gltf", builder.gltf()),
          folder.write("c.gltf", builder.finished("my%20data.bin").dump()),
          folder.write("d.gltf", "\xEF\xBB\xBF \n" + builder.gltf()), folder.write("e.anything", builder.glb())}) {
        const auto [scene, warnings] = load_file(path);
        CHECK(scene.positions == std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
        CHECK(warnings.empty());
    }
}

TEST_CASE("the hash covers the file, its external buffers and its external textures") {
    const TempFolder folder;
    GltfBuilder builder = simple();
    builder.add("images", {{"uri", "tile.png"}});
    builder.add("textures", {{"source", 0}});
    builder.doc["meshes"][0]["primitives"][0]["material"] =
        builder.add("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
    folder.write("tile.png", png_rgb);
    folder.write("data.bin", builder.bin);
    const std::string path = folder.write("a.gltf", builder.finished("data.bin").dump());
    const std::uint64_t hash = load_file(path).scene.hash;
    CHECK(load_file(path).scene.hash == hash);
    folder.write("tile.png", png_grey);
    const std::uint64_t other_texture = load_file(path).scene.hash;
    CHECK(other_texture != hash);
    builder.bin[4] ^= 1;
    folder.write("data.bin", builder.bin);
    CHECK(load_file(path).scene.hash != other_texture);
}

TEST_CASE("a missing file, a folder and an empty file are errors that say so") {
    const TempFolder folder;
    CHECK(mentions(error_of(folder.file("none.glb")), "expected a file that can be read, found none"));
    CHECK(mentions(error_of(folder.file(".")), "found a folder"));
    CHECK(mentions(error_of("/dev/zero"), "found a device"));
    CHECK(mentions(error_of(folder.write("empty.glb", "")), "an empty file"));
    CHECK(mentions(error_of(folder.file("new\nline.glb")), "new line.glb"));
}

TEST_CASE("a .glb cut short anywhere is an error") {
    const TempFolder folder;
    const auto whole = simple().glb();
    for (std::size_t size = 0; size < whole.size(); ++size) {
        const std::string path =
            folder.write("cut.glb", std::vector<std::uint8_t>(whole.begin(), whole.begin() + static_cast<long>(size)));
        INFO(size);
        CHECK(mentions(error_of(path), "cut.glb: "));
    }
}

TEST_CASE("a .gltf cut short anywhere is an error") {
    const TempFolder folder;
    const std::string whole = simple().gltf();
    for (std::size_t size = 0; size < whole.size(); size += 7)
        CHECK(mentions(error_of(folder.write("cut.gltf", whole.substr(0, size))), "cut.gltf: "));
}

TEST_CASE("files that are not glTF 2.0 are errors that say what was found") {
    const TempFolder folder;
    const auto error = [&](const std::string& text) { return error_of(folder.write("x.gltf", text)); };
    CHECK(mentions(error("solid cube"), "expected a glTF 2.0 file"));
    CHECK(mentions(error("  \n "), "expected a glTF 2.0 file"));
    CHECK(mentions(error("{]"), "expected valid JSON"));
    CHECK(mentions(error("{}"), "this is JSON but not glTF"));
    CHECK(mentions(error("{\"asset\":{\"version\":\"1.0\"}}"), "found \"1.0\""));
    CHECK(mentions(error("{\"asset\":{\"version\":2.0}}"), "expected \"2.0\", found none"));
    CHECK(mentions(error("{\"asset\":[]}"), "expected \"2.0\", found none"));
    CHECK(mentions(error("{\"asset\":{\"version\":\"2.0\"}}"), "expected at least one triangle"));
    CHECK(mentions(error("{\"asset\":{\"version\":\"2.0\"},\"buffers\":7}"), "expected an array, found number"));
    CHECK(mentions(error("{\"asset\":{\"version\":\"2.0\"},\"buffers\":[7]}"), "expected an object, found number"));
    CHECK(mentions(error("{\"a\":\"\xFF\xFE\"}"), "expected valid JSON"));
    auto version1 = simple().glb();
    version1[4] = 1;
    CHECK(mentions(error_of(folder.write("x.glb", version1)), "found version 1"));
}

TEST_CASE("JSON nested beyond any glTF is an error, not a stack overflow") {
    const TempFolder folder;
    const std::string deep(200000, '[');
    CHECK(mentions(error_of(folder.write("x.gltf", "{\"asset\":{\"version\":\"2.0\"},\"x\":" + deep)), "expected"));
    const std::string closed = "{\"x\":" + deep + std::string(200000, ']') + "}";
    CHECK(mentions(error_of(folder.write("x.gltf", closed)), "64 nested levels"));
}

TEST_CASE("extras of any shape are ignored") {
    GltfBuilder builder = simple();
    builder.doc["extras"] = {{"a", {1, 2, {{"extras", "x"}}}}};
    builder.doc["nodes"][0]["extras"] = "text";
    CHECK(load(builder).scene.triangle_count() == 1);
}

TEST_CASE("a required extension that is not understood is an error that names it") {
    GltfBuilder builder = simple();
    builder.doc["extensionsRequired"] = builder.doc["extensionsUsed"] = {"KHR_draco_mesh_compression"};
    CHECK(mentions(error_of(builder), "found KHR_draco_mesh_compression"));
    builder.doc["extensionsRequired"] = builder.doc["extensionsUsed"] = {"KHR_materials_emissive_strength"};
    CHECK(load(builder).scene.triangle_count() == 1);
}

TEST_CASE("buffers that are missing, short or remote are errors") {
    const TempFolder folder;
    const GltfBuilder builder = simple();
    const auto error = [&](const std::string& uri) {
        return error_of(folder.write("x.gltf", builder.finished(uri).dump()));
    };
    CHECK(mentions(error("none.bin"), "buffer 0"));
    CHECK(mentions(error("https://example.org/a.bin"), "expected a relative path or a data: URI"));
    CHECK(mentions(error("/etc/passwd"), "expected a relative path or a data: URI"));
    CHECK(mentions(error("a%0.bin"), "expected a relative path or a data: URI"));
    CHECK(mentions(error("a%00.bin"), "expected a relative path or a data: URI"));
    CHECK(mentions(error("data:application/octet-stream;base64,AAAA"), "expected 36 bytes, found 3"));
    CHECK(mentions(error("data:application/octet-stream;base64,A"), "base64"));
    CHECK(mentions(error("data:text/plain,hello"), "base64"));
    CHECK(mentions(error(""), "expected a URI or the file's BIN chunk, found neither"));
    folder.write("short.bin", "abc");
    CHECK(mentions(error("short.bin"), "expected 36 bytes, found 3"));
    json no_length = builder.finished("short.bin");
    no_length["buffers"][0]["byteLength"] = -1;
    CHECK(mentions(error_of(folder.write("x.gltf", no_length.dump())), "expected a byteLength"));
}
