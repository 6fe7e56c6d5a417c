#include <catch2/catch.hpp>

#include "tests/tracer/gltf_files.hpp"

using namespace raycache;
using namespace raycache::tracer;
using namespace raycache::tracer::test;

namespace {

/// A triangle with TEXCOORD_0 and TEXCOORD_1 and one material, whose base colour texture is `image`.
GltfBuilder textured(const json& image, json material = json::object(), int set = 0) {
    GltfBuilder builder;
    const int first = builder.floats({0, 0, 1, 0, 0, 1}, "VEC2");
    const int second = builder.accessor(std::vector<std::uint16_t>{0, 0, 65535, 0, 0, 65535}, "VEC2", 5123, true);
    material["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}, {"texCoord", set}};
    builder.place(
        {{"attributes", {{"POSITION", builder.triangle_positions()}, {"TEXCOORD_0", first}, {"TEXCOORD_1", second}}},
         {"material", builder.add("materials", material)}});
    builder.add("textures", {{"source", 0}});
    builder.add("images", image);
    return builder;
}

std::string data_uri(const std::vector<std::uint8_t>& bytes) { return "data:image/png;base64," + base64(bytes); }

GltfBuilder with_material(const json& material) {
    GltfBuilder builder;
    builder.place({{"attributes", {{"POSITION", builder.triangle_positions()}}},
                   {"material", builder.add("materials", material)}});
    return builder;
}

}  // namespace

TEST_CASE("the base colour factor, alpha and name of a material are kept") {
    const auto [scene, warnings] = load(
        with_material({{"name", "red\npaint"}, {"pbrMetallicRoughness", {{"baseColorFactor", {1, 0.25, 0, 0.5}}}}}));
    REQUIRE(scene.materials.size() == 1);
    CHECK(scene.materials[0].name == "red paint");
    CHECK(scene.materials[0].base_color == Vec3{1, 0.25F, 0});
    CHECK(scene.materials[0].alpha == 0.5F);
    CHECK(scene.materials[0].base_color_texture == -1);
    CHECK(warnings.empty());
}

TEST_CASE("a base colour texture is decoded to RGBA8 wherever its bytes are") {
    const TempFolder folder;
    std::string path;
    SECTION("in a data: URI") { path = folder.write("a.glb", textured({{"uri", data_uri(png_rgba)}}).glb()); }
    SECTION("in a file beside the scene, with a percent-encoded name") {
        folder.write("my tile.png", png_rgba);
        path = folder.write("a.glb", textured({{"uri", "my%20tile.png"}}).glb());
    }
    SECTION("in a buffer view") {
        GltfBuilder builder = textured(json::object());
        builder.doc["images"][0] = {{"bufferView", builder.view(png_rgba.data(), png_rgba.size())},
                                    {"mimeType", "image/png"}};
        path = folder.write("a.glb", builder.glb());
    }
    const auto [scene, warnings] = load_file(path);
    CHECK(warnings.empty());
    REQUIRE(scene.textures.size() == 1);
    CHECK(scene.textures[0].width == 2);
    CHECK(scene.textures[0].height == 2);
    CHECK(scene.textures[0].rgba ==
          std::vector<std::uint8_t>{255, 0, 0, 255, 0, 255, 0, 128, 0, 0, 255, 0, 200, 100, 50, 64});
    CHECK(scene.materials[0].base_color_texture == 0);
    CHECK(scene.texcoords == std::vector<Vec2>{{0, 0}, {1, 0}, {0, 1}});
}

TEST_CASE("normalised integer texture coordinates of the set a texture asks for become floats") {
    const Scene scene = load(textured({{"uri", data_uri(png_rgba)}}, json::object(), 1)).scene;
    CHECK(scene.texcoords == std::vector<Vec2>{{0, 0}, {1, 0}, {0, 1}});
    GltfBuilder builder = textured({{"uri", data_uri(png_rgba)}});
    const int bytes = builder.accessor(std::vector<std::uint8_t>{0, 0, 255, 0, 51, 255}, "VEC2", 5121, true);
    builder.doc["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = bytes;
    CHECK(load(builder).scene.texcoords[2] == Vec2{0.2F, 1});
}

TEST_CASE("texture coordinates of untextured meshes are not kept") {
    GltfBuilder builder;
    builder.place(
        {{"attributes",
          {{"POSITION", builder.triangle_positions()}, {"TEXCOORD_0", builder.floats({0, 0, 1, 0, 0, 1}, "VEC2")}}}});
    CHECK(load(builder).scene.texcoords.empty());
}

TEST_CASE("an image that two textures share is decoded once") {
    GltfBuilder builder = textured({{"uri", data_uri(png_rgb)}});
    builder.add("textures", {{"source", 0}});
    const int other = builder.add("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 1}}}}}});
    builder.place(
        {{"attributes",
          {{"POSITION", builder.triangle_positions()}, {"TEXCOORD_0", builder.floats({0, 0, 1, 0, 0, 1}, "VEC2")}}},
         {"material", other}});
    const Scene scene = load(builder).scene;
    CHECK(scene.textures.size() == 1);
    CHECK(scene.materials[1].base_color_texture == 0);
}

TEST_CASE("images of textures that are not read, or of materials that are not placed, are not touched") {
    GltfBuilder builder = with_material({{"occlusionTexture", {{"index", 0}}}});
    builder.add("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
    builder.add("textures", {{"source", 0}});
    builder.add("images", {{"uri", "missing.png"}});
    const auto [scene, warnings] = load(builder);
    CHECK(scene.textures.empty());
    CHECK(warnings.empty());
}

TEST_CASE("a texture that cannot be had leaves the factor alone, with one warning") {
    json image;
    SECTION("missing file") { image = {{"uri", "missing.png"}}; }
    SECTION("folder") { image = {{"uri", "."}}; }
    SECTION("remote") { image = {{"uri", "https://example.org/a.png"}}; }
    SECTION("not base64") { image = {{"uri", "data:image/png;base64,?!"}}; }
    SECTION("not an image") { image = {{"uri", data_uri({1, 2, 3, 4})}}; }
    SECTION("truncated image") {
        image = {{"uri", data_uri(std::vector<std::uint8_t>(png_rgba.begin(), png_rgba.begin() + 45))}};
    }
    SECTION("buffer view out of range") { image = {{"bufferView", 99}}; }
    SECTION("image of a size that no memory holds") { image = {{"uri", data_uri(png_huge)}}; }
    SECTION("neither URI nor buffer view") { image = json::object(); }
    const auto [scene, warnings] = load(textured(image));
    CHECK(scene.textures.empty());
    CHECK(scene.materials[0].base_color_texture == -1);
    REQUIRE(warnings.size() == 1);
    CHECK(warnings[0].find("1 textures cannot be used") != std::string::npos);
    CHECK(warnings[0].find('\n') == std::string::npos);
}

TEST_CASE("a textured mesh without the texture coordinates asked for gets zeros and a warning") {
    const auto [scene, warnings] = load(textured({{"uri", data_uri(png_rgb)}}, json::object(), 3));
    CHECK(scene.texcoords.empty());
    REQUIRE(warnings.size() == 1);
    CHECK(warnings[0].find("1 textured primitives lack") != std::string::npos);
}

TEST_CASE("MASK keeps its cutoff, BLEND its alpha unless that is always 1") {
    GltfBuilder builder = with_material({{"alphaMode", "MASK"}, {"alphaCutoff", 0.25}});
    const int blend = builder.add(
        "materials", {{"alphaMode", "BLEND"}, {"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, 0.25}}}}});
    const int full = builder.add("materials", {{"alphaMode", "BLEND"}});
    const int unset = builder.add("materials", {{"alphaMode", "MASK"}});
    for (const int material : {blend, full, unset})
        builder.place({{"attributes", {{"POSITION", builder.triangle_positions()}}}, {"material", material}});
    const auto [scene, warnings] = load(builder);
    CHECK(scene.materials[0].alpha_mask);
    CHECK(scene.materials[0].alpha_cutoff == 0.25F);
    CHECK_FALSE(scene.materials[0].alpha_blend);
    CHECK_FALSE(scene.materials[1].alpha_mask);
    CHECK(scene.materials[1].alpha_blend);
    CHECK(scene.materials[1].alpha == 0.25F);
    CHECK_FALSE(scene.materials[2].alpha_blend);
    CHECK(scene.materials[3].alpha_cutoff == 0.5F);
    CHECK(warnings.empty());
}

TEST_CASE("emission is the factor times the strength") {
    GltfBuilder builder =
        with_material({{"emissiveFactor", {1, 0.5, 0}},
                       {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 8.0}}}}}});
    builder.doc["extensionsUsed"] = {"KHR_materials_emissive_strength"};
    const auto [scene, warnings] = load(builder);
    CHECK(scene.materials[0].emission == Vec3{8, 4, 0});
    CHECK(warnings.empty());
    CHECK(load(with_material({{"emissiveFactor", {1, 0.5, 0}}})).scene.materials[0].emission == Vec3{1, 0.5F, 0});
}

TEST_CASE("a normal map is left out with a warning") {
    GltfBuilder builder = with_material({{"normalTexture", {{"index", 0}}}});
    builder.add("textures", {{"source", 0}});
    builder.add("images", {{"uri", "missing.png"}});
    const auto [scene, warnings] = load(builder);
    CHECK(scene.textures.empty());
    REQUIRE(warnings.size() == 1);
    CHECK(warnings[0].find("1 materials have a normal map") != std::string::npos);
}

TEST_CASE("emission out of glTF's range is the nearest in it or taken as it is, with a warning") {
    const auto negative = load(with_material({{"emissiveFactor", {-1, 0.5, 0}}}));
    CHECK(negative.scene.materials[0].emission == Vec3{0, 0.5F, 0});
    REQUIRE(negative.warnings.size() == 1);
    CHECK(negative.warnings[0].find("1 materials have a factor out of glTF's range") != std::string::npos);
    const auto bright = load(with_material({{"emissiveFactor", {5, 0, 0}}}));
    CHECK(bright.scene.materials[0].emission == Vec3{5, 0, 0});
    REQUIRE(bright.warnings.size() == 1);
    CHECK(bright.warnings[0].find("1 materials have an emissive factor above 1") != std::string::npos);
    CHECK(error_of(with_material({{"emissiveFactor", {1e30, 0, 0}}}))
              .find("found a factor of 1e+30, 0, 0 and a strength of 1") != std::string::npos);
}

TEST_CASE("material references and values out of range are errors that name them") {
    GltfBuilder builder = textured({{"uri", data_uri(png_rgb)}});
    std::string expected;
    SECTION("material") {
        builder.doc["meshes"][0]["primitives"][0]["material"] = 7;
        expected = "expected a material below 1, found 7";
    }
    SECTION("negative material") {
        builder.doc["meshes"][0]["primitives"][0]["material"] = -2;
        expected = "expected a material below 1, found -2";
    }
    SECTION("texture") {
        builder.doc["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["index"] = 9;
        expected = "expected a texture below 1, found 9";
    }
    SECTION("image") {
        builder.doc["textures"][0]["source"] = 5;
        expected = "expected an image below 1, found 5";
    }
    SECTION("sampler") {
        builder.doc["textures"][0]["sampler"] = 0;
        expected = "expected a sampler below 0, found 0";
    }
    SECTION("texture coordinate set") {
        builder.doc["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["texCoord"] = -3;
        expected = "texCoord: expected an integer of 0 or more, found -3";
    }
    SECTION("alpha mode") {
        builder.doc["materials"][0]["alphaMode"] = "GLOW";
        expected = "found \"GLOW\"";
    }
    SECTION("colour of three numbers") {
        builder.doc["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = {1, 1, 1};
        expected = "baseColorFactor: expected 4 numbers, found [1,1,1]";
    }
    SECTION("emission beyond every float") {
        builder.doc["materials"][0]["emissiveFactor"] = {1e300, 0, 0};
        expected = "emission";
    }
    const std::string message = error_of(builder);
    INFO(message);
    CHECK(message.find(expected) != std::string::npos);
    CHECK(message.find('\n') == std::string::npos);
}
