// What the loader makes of metal, roughness and glass.
#include <catch2/catch.hpp>

#include "tests/tracer/gltf_files.hpp"

using namespace raycache;
using namespace raycache::tracer;
using namespace raycache::tracer::test;

namespace {

GltfBuilder with_material(const json& material) {
    GltfBuilder builder;
    builder.place({{"attributes",
                    {{"POSITION", builder.triangle_positions()},
                     {"TEXCOORD_0", builder.floats({0, 0, 1, 0, 0, 1}, "VEC2")},
                     {"TEXCOORD_1", builder.floats({0, 0, 1, 0, 0, 1}, "VEC2")}}},
                   {"material", builder.add("materials", material)}});
    return builder;
}

json surface(double metallic, double roughness) {
    return {{"pbrMetallicRoughness", {{"metallicFactor", metallic}, {"roughnessFactor", roughness}}}};
}

json glass(const json& transmission, const json& ior, const json& volume) {
    json material = surface(0, 0);
    if (!transmission.is_null()) material["extensions"]["KHR_materials_transmission"] = transmission;
    if (!ior.is_null()) material["extensions"]["KHR_materials_ior"] = ior;
    if (!volume.is_null()) material["extensions"]["KHR_materials_volume"] = volume;
    return material;
}

/// A material with a base colour texture and a metallic-roughness texture of two images.
GltfBuilder two_textures(int color_set, int rough_set, const std::string& rough_uri) {
    json material;
    material["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}, {"texCoord", color_set}};
    material["pbrMetallicRoughness"]["metallicRoughnessTexture"] = {{"index", 1}, {"texCoord", rough_set}};
    GltfBuilder builder = with_material(material);
    builder.add("textures", {{"source", 0}});
    builder.add("textures", {{"source", 1}});
    builder.add("images", {{"uri", "data:image/png;base64," + base64(png_rgba)}});
    builder.add("images", {{"uri", rough_uri}});
    return builder;
}

}  // namespace

TEST_CASE("metallic and roughness factors are kept; without any, glTF says rough metal") {
    const Scene given = load(with_material(surface(0.25, 0.5))).scene;
    CHECK(given.materials[0].metallic == 0.25F);
    CHECK(given.materials[0].roughness == 0.5F);
    CHECK_FALSE(given.materials[0].diffuse());
    const Scene unset = load(with_material(json::object())).scene;
    CHECK(unset.materials[0].metallic == 1);
    CHECK(unset.materials[0].roughness == 1);
    GltfBuilder bare;
    bare.place_triangle();
    CHECK(load(bare).scene.materials[0].metallic == 1);
    CHECK(load(with_material(surface(0, 1))).scene.materials[0].diffuse());
}

TEST_CASE("glass is a pane without a volume's thickness and a solid with it") {
    const Scene pane = load(with_material(glass({{"transmissionFactor", 0.75}}, {{"ior", 1.25}}, nullptr))).scene;
    CHECK(pane.materials[0].transmission == 0.75F);
    CHECK(pane.materials[0].ior == 1.25F);
    CHECK(pane.materials[0].thin);
    CHECK_FALSE(pane.materials[0].diffuse());
    const auto [solid, warnings] =
        load(with_material(glass({{"transmissionFactor", 1}}, nullptr, {{"thicknessFactor", 1}})));
    CHECK_FALSE(solid.materials[0].thin);
    CHECK(solid.materials[0].ior == 1.5F);
    CHECK(warnings.empty());
    CHECK(load(with_material(glass({{"transmissionFactor", 1}}, nullptr, {{"thicknessFactor", 0}})))
              .scene.materials[0]
              .thin);
    CHECK(load(with_material(glass(json::object(), {{"ior", 0}}, nullptr))).scene.materials[0].ior == 0);
}

TEST_CASE("surface factors out of range become the nearest in it, with one warning for the file") {
    json material;
    Material expected;
    expected.metallic = 0;
    expected.roughness = 0;
    SECTION("metallic above 1") { material = surface(1.5, 0), expected.metallic = 1; }
    SECTION("metallic below 0") { material = surface(-1, 0); }
    SECTION("roughness above 1") { material = surface(0, 1e30), expected.roughness = 1; }
    SECTION("roughness below 0") { material = surface(0, -1e-3); }
    SECTION("transmission above 1") {
        material = glass({{"transmissionFactor", 7}}, nullptr, nullptr), expected.transmission = 1;
    }
    SECTION("index between 0 and 1") { material = glass(nullptr, {{"ior", 0.5}}, nullptr), expected.ior = 1; }
    SECTION("negative index") { material = glass(nullptr, {{"ior", -2}}, nullptr), expected.ior = 1; }
    SECTION("index beyond any matter") { material = glass(nullptr, {{"ior", 1e30}}, nullptr), expected.ior = 100; }
    GltfBuilder builder = with_material(material);
    builder.place({{"attributes", {{"POSITION", builder.triangle_positions()}}},
                   {"material", builder.add("materials", material)}});
    const auto [scene, warnings] = load(builder);
    const Material& found = scene.materials[0];
    CHECK(found.metallic == expected.metallic);
    CHECK(found.roughness == expected.roughness);
    CHECK(found.transmission == expected.transmission);
    CHECK(found.ior == expected.ior);
    REQUIRE(warnings.size() == 1);
    CHECK(warnings[0].find("2 materials have a factor out of glTF's range") != std::string::npos);
}

TEST_CASE("surface factors that are no numbers are errors that name them") {
    json material;
    std::string name;
    SECTION("transmission") {
        material = glass({{"transmissionFactor", "much"}}, nullptr, nullptr);
        name = "KHR_materials_transmission.transmissionFactor";
    }
    SECTION("index") { material = glass(nullptr, {{"ior", {1.5}}}, nullptr), name = "KHR_materials_ior.ior"; }
    SECTION("thickness") {
        material = glass(nullptr, nullptr, {{"thicknessFactor", {{"metres", 1}}}});
        name = "KHR_materials_volume.thicknessFactor";
    }
    const std::string message = error_of(with_material(material));
    INFO(message);
    CHECK(message.find("materials[0].extensions." + name + ": expected a number") != std::string::npos);
    CHECK(message.find('\n') == std::string::npos);
}

TEST_CASE("a metallic-roughness texture has the base colour's coordinates or a layer of its own") {
    const std::string uri = "data:image/png;base64," + base64(png_rgb);
    const auto [scene, warnings] = load(two_textures(0, 0, uri));
    CHECK(warnings.empty());
    CHECK(scene.textures.size() == 2);
    CHECK(scene.materials[0].base_color_texture == 0);
    CHECK(scene.materials[0].metallic_roughness_texture == 1);
    CHECK(scene.more_texcoords.empty());
    const auto other = load(two_textures(0, 1, uri));
    CHECK(other.warnings.empty());
    CHECK(other.scene.materials[0].metallic_roughness_texture == 1);
    CHECK(other.scene.materials[0].metallic_roughness_lookup.layer == 1);
    REQUIRE(other.scene.more_texcoords.size() == 1);
    CHECK(other.scene.more_texcoords[0] == other.scene.texcoords);
}

TEST_CASE("a metallic-roughness texture that cannot be had leaves the factors alone, with one warning") {
    const auto [scene, warnings] = load(two_textures(0, 0, "missing.png"));
    CHECK(scene.textures.size() == 1);
    CHECK(scene.materials[0].base_color_texture == 0);
    CHECK(scene.materials[0].metallic_roughness_texture == -1);
    CHECK(scene.materials[0].metallic == 1);
    REQUIRE(warnings.size() == 1);
    CHECK(warnings[0].find("1 textures cannot be used and the material's factors alone are") != std::string::npos);
}

TEST_CASE("what glass can do and we cannot is one warning each") {
    const json absorbing = {{"thicknessFactor", 1}, {"attenuationDistance", 0.5}};
    const auto volume = load(with_material(glass({{"transmissionFactor", 1}}, nullptr, absorbing))).warnings;
    REQUIRE(volume.size() == 1);
    CHECK(volume[0].find("1 materials absorb light in their volume") != std::string::npos);
    const json textured = {{"transmissionFactor", 1}, {"transmissionTexture", {{"index", 0}}}};
    const auto texture = load(with_material(glass(textured, nullptr, nullptr))).warnings;
    REQUIRE(texture.size() == 1);
    CHECK(texture[0].find("transmission texture; the factors alone are used") != std::string::npos);
}
