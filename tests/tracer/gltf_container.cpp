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
    CHECK(mentions(error("{\"asset\":{\"version\":2.0}}"), "found the number 2.0"));
    CHECK(mentions(error("{\"asset\":[]}"), "expected \"2.0\", found none"));
    CHECK(mentions(error("{\"asset\":{\"version\":\"2.0\"}}"), "expected at least one triangle"));
    CHECK(mentions(error("{\"asset\":{\"version\":\"2.0\"},\"buffers\":7}"),
                   "buffers: expected an array of objects, found 7"));
    CHECK(mentions(error("{\"asset\":{\"version\":\"2.0\"},\"buffers\":[7]}"),
                   "buffers[0]: expected an object, found 7"));
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

TEST_CASE("a required extension that may hold geometry is an error that names it") {
    GltfBuilder builder = simple();
    for (const char* name : {"ACME_shapes", "KHR_meshopt_compression"}) {
        builder.doc["extensionsRequired"] = builder.doc["extensionsUsed"] = {name};
        CHECK(mentions(error_of(builder), std::string("found ") + name));
    }
    CHECK(mentions(error_of(builder), "gltf-transform"));
    builder.doc["extensionsRequired"] = builder.doc["extensionsUsed"] = {"KHR_materials_emissive_strength"};
    CHECK(load(builder).scene.triangle_count() == 1);
    builder.doc["extensionsRequired"] = json::array({7});
    CHECK(mentions(error_of(builder), "extensionsRequired[0]: expected a string, found 7"));
}

TEST_CASE("an extension of look or light is left out, required or not, with one warning that says what is missing") {
    GltfBuilder builder = simple();
    builder.doc["extensionsUsed"] = {"KHR_materials_unlit", "KHR_materials_ior", "KHR_xmp_json_ld", "ACME_paint"};
    for (const bool required : {false, true}) {
        if (required) builder.doc["extensionsRequired"] = {"KHR_materials_unlit", "KHR_materials_clearcoat"};
        const auto [scene, warnings] = load(builder);
        REQUIRE(warnings.size() == 1);
        CHECK(mentions(warnings[0], "KHR_materials_unlit (unlit materials are lit like others)"));
        CHECK(mentions(warnings[0], "ACME_paint"));
        CHECK(mentions(warnings[0], "KHR_materials_clearcoat (clear coats)") == required);
        CHECK_FALSE(mentions(warnings[0], "KHR_xmp"));
    }
}

TEST_CASE("a .glb whose lengths contradict each other is an error that says which") {
    const TempFolder folder;
    const auto whole = simple().glb();
    const auto error = [&](std::size_t at, std::uint32_t value) {
        auto bytes = whole;
        for (std::size_t i = 0; i < 4; ++i) bytes[at + i] = static_cast<std::uint8_t>(value >> (8 * i));
        return error_of(folder.write("x.glb", bytes));
    };
    const auto size = static_cast<std::uint32_t>(whole.size());
    for (const std::uint32_t length : {size - 1, size - 30, 100U})
        CHECK(mentions(error(8, length), "GLB header: expected a length of at least"));
    for (const std::uint32_t length : {0U, 12U, 19U})
        CHECK(mentions(error(8, length), "GLB header: expected a length of at least"));
    CHECK(mentions(error(8, size + 4), "the file is truncated"));
    CHECK(mentions(error(12, 0xFFFFFFF0U), "GLB chunk 0: expected a length of at most"));
    CHECK(mentions(error(12, 0), "GLB chunk 0: expected a JSON text"));
    auto longer = whole;
    longer.insert(longer.end(), 8, 0);
    CHECK(load_file(folder.write("longer.glb", longer)).scene.triangle_count() == 1);
}

TEST_CASE("a .glb chunk whose length is no multiple of 4 is read, with a warning") {
    const TempFolder folder;
    GltfBuilder builder = simple();
    std::string text = builder.finished().dump();
    while (text.size() % 4 != 1) text += ' ';
    auto bytes = builder.glb(text);  // padded to 4: takes the padding away again
    const std::size_t padded = (text.size() + 3) / 4 * 4;
    bytes.erase(bytes.begin() + 20 + static_cast<long>(text.size()), bytes.begin() + 20 + static_cast<long>(padded));
    for (std::size_t i = 0; i < 4; ++i) {
        bytes[8 + i] = static_cast<std::uint8_t>(bytes.size() >> (8 * i));
        bytes[12 + i] = static_cast<std::uint8_t>(text.size() >> (8 * i));
    }
    const auto [scene, warnings] = load_file(folder.write("odd.glb", bytes));
    CHECK(scene.triangle_count() == 1);
    REQUIRE(warnings.size() == 1);
    CHECK(mentions(warnings[0], "GLB chunk 0: its length of"));
}

TEST_CASE(
    "a file name with a % or a backslash that is no escape is found, with a warning; if missing, the error says why") {
    const TempFolder folder;
    const GltfBuilder builder = simple();
    std::filesystem::create_directory(folder.file("my files"));
    for (const char* name : {"10%.bin", "my files/a%2.bin", "b%41.bin", "my files/c.bin"})
        folder.write(name, builder.bin);
    const auto loaded = [&](const std::string& uri) {
        return load_file(folder.write("x.gltf", builder.finished(uri).dump()));
    };
    CHECK(mentions(loaded("10%.bin").warnings.at(0), "\"10%.bin\" is taken as it is"));
    CHECK(mentions(loaded("b%41.bin").warnings.at(0), "is taken as it is"));
    CHECK(mentions(loaded("my files\\c.bin").warnings.at(0), "has backslashes"));
    CHECK(mentions(loaded("my%20files\\c.bin").warnings.at(0), "has backslashes"));
    CHECK(mentions(loaded("my files\\a%2.bin").warnings.at(0), "has backslashes"));
    CHECK(loaded("my%20files/c.bin").warnings.empty());
    const auto error = [&](const std::string& uri) {
        return error_of(folder.write("x.gltf", builder.finished(uri).dump()));
    };
    CHECK(mentions(error("no\\c.bin"), "its backslash is no separator"));
    CHECK(mentions(error("20%.bin"), "its % begins no escape"));
    CHECK_FALSE(mentions(error("plain.bin"), "%"));
    for (const char* uri : {"20%.png", "no\\c.png"}) {
        GltfBuilder textured = simple();
        textured.add("images", {{"uri", uri}});
        textured.add("textures", {{"source", 0}});
        textured.doc["meshes"][0]["primitives"][0]["material"] =
            textured.add("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
        std::string all;
        for (const std::string& warning : load(textured).warnings) all += warning + " ";
        CHECK((mentions(all, "its backslash") || mentions(all, "its % begins")));
    }
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
    CHECK(mentions(error_of(folder.write("x.gltf", no_length.dump())),
                   "buffers[0].byteLength: expected an integer of 1 or more, found -1"));
}
