#include <catch2/catch.hpp>
#include <random>

#include "tests/tracer/gltf_files.hpp"

using namespace raycache;
using namespace raycache::tracer;
using namespace raycache::tracer::test;

namespace {

/// A file with most features: hierarchy, indices, sparse, strip, texture, camera, materials.
GltfBuilder rich() {
    GltfBuilder builder;
    const int positions = builder.triangle_positions();
    const int normals = builder.floats({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
    const int uv = builder.floats({0, 0, 1, 0, 0, 1}, "VEC2");
    const int indices = builder.accessor(std::vector<std::uint16_t>{0, 1, 2, 2, 1, 0}, "SCALAR", 5123);
    const std::uint8_t where = 2;
    const std::vector<float> what{0, 2, 0};
    const int sparse = builder.triangle_positions();
    builder.doc["accessors"][static_cast<std::size_t>(sparse)]["sparse"] = {
        {"count", 1},
        {"indices", {{"bufferView", builder.view(&where, 1)}, {"componentType", 5121}}},
        {"values", {{"bufferView", builder.view(what.data(), 12)}}}};
    builder.doc["extensionsUsed"] = {"KHR_materials_emissive_strength"};
    builder.add("materials",
                {{"name", "tile"},
                 {"alphaMode", "MASK"},
                 {"alphaCutoff", 0.5},
                 {"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, 1}}, {"baseColorTexture", {{"index", 0}}}}}});
    builder.add("materials", {{"emissiveFactor", {1, 1, 1}},
                              {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 3.5}}}}}});
    builder.add("samplers", {{"wrapS", 10497}, {"wrapT", 33071}});
    builder.add("textures", {{"source", 0}, {"sampler", 0}});
    builder.add("images", {{"bufferView", builder.view(png_rgba.data(), png_rgba.size())}, {"mimeType", "image/png"}});
    builder.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 1.0}, {"znear", 0.1}}}});
    const int first = builder.mesh({{"attributes", {{"POSITION", positions}, {"NORMAL", normals}, {"TEXCOORD_0", uv}}},
                                    {"indices", indices},
                                    {"material", 0}});
    const int second = builder.mesh({{"attributes", {{"POSITION", sparse}}}, {"mode", 5}, {"material", 1}});
    builder.node({{"children", {1, 2}}, {"matrix", {-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1}}});
    builder.node({{"mesh", first}, {"rotation", {0, 0, 0.6, 0.8}}});
    builder.node({{"mesh", second}, {"translation", {1, 2, 3}}, {"scale", {1, 2, 1}}});
    builder.node({{"camera", 0}, {"name", "eye"}});
    const int moved = builder.floats({0, 1, 0, 0, 1, 0, 0, 1, 0}, "VEC3");
    const int third = builder.mesh(
        {{"attributes",
          {{"POSITION", positions},
           {"TEXCOORD_0", uv},
           {"COLOR_0", builder.accessor(std::vector<std::uint8_t>(12, 128), "VEC4", 5121, true)},
           {"JOINTS_0", builder.accessor(std::vector<std::uint8_t>{0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0}, "VEC4", 5121)},
           {"WEIGHTS_0", builder.floats({1, 0, 0, 0, 1, 0, 0, 0, 0.5F, 0.5F, 0, 0}, "VEC4")}}},
         {"targets", {{{"POSITION", moved}, {"NORMAL", moved}}}},
         {"material", 2}});
    builder.doc["meshes"].back()["weights"] = {0.25};
    builder.add("materials",
                {{"emissiveFactor", {1, 1, 1}},
                 {"emissiveTexture",
                  {{"index", 0}, {"extensions", {{"KHR_texture_transform", {{"offset", {0.5, 0}}, {"rotation", 1}}}}}}},
                 {"extensions", {{"KHR_materials_pbrSpecularGlossiness", {{"diffuseFactor", {0, 1, 0, 1}}}}}}});
    builder.node({{"mesh", third}, {"skin", 0}});
    builder.node({{"mesh", third},
                  {"weights", {1.0}},
                  {"extensions",
                   {{"EXT_mesh_gpu_instancing", {{"attributes", {{"TRANSLATION", moved}}}}},
                    {"KHR_node_visibility", {{"visible", true}}},
                    {"KHR_lights_punctual", {{"light", 0}}}}}});
    builder.doc["skins"] = {{{"joints", {1, 2}}}};
    builder.doc["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "spot"}, {"intensity", 2}, {"spot", {{"outerConeAngle", 0.5}}}}};
    builder.doc["scenes"] = {{{"nodes", {0, 3, 4, 5}}}};
    builder.doc["scene"] = 0;
    return builder;
}

/// Loads and checks what every Scene promises, or sees an Error of one line.
void load_or_refuse(const std::string& path) {
    try {
        const Scene scene = load_file(path).scene;
        const std::size_t vertices = scene.positions.size();
        bool sound = scene.triangle_count() > 0 && scene.indices.size() == 3 * scene.triangle_count() &&
                     (scene.normals.empty() || scene.normals.size() == vertices) &&
                     (scene.texcoords.empty() || scene.texcoords.size() == vertices) && !scene.cameras.empty() &&
                     (scene.colors.empty() || scene.colors.size() == vertices);
        for (const auto& layer : scene.more_texcoords) sound = sound && layer.size() == vertices;
        for (const std::uint32_t i : scene.indices) sound = sound && i < vertices;
        for (const std::uint16_t m : scene.material_of) sound = sound && m < scene.materials.size();
        for (const Vec3 p : scene.positions) sound = sound && is_finite(p);
        for (const Vec3 n : scene.normals) sound = sound && (n == Vec3{} || std::abs(length(n) - 1) < 1e-3F);
        for (const Material& m : scene.materials)
            sound = sound && m.base_color_texture < static_cast<int>(scene.textures.size());
        CHECK(sound);
    } catch (const Error& e) {
        CHECK(std::string(e.what()).find('\n') == std::string::npos);
    }
}

}  // namespace

TEST_CASE("the file that is mutated below loads whole") {
    const auto [scene, warnings] = load(rich());
    CHECK(scene.triangle_count() == 7);
    CHECK(scene.punctual_lights.size() == 1);
    CHECK(scene.textures.size() == 1);
    CHECK(scene.cameras[0].name == "eye");
    CHECK(warnings.empty());
}

TEST_CASE("a .glb with flipped bytes loads or is refused with an Error", "[slow]") {
    const TempFolder folder;
    const auto whole = rich().glb();
    std::mt19937 random(20240601);
    for (int i = 0; i < 2000; ++i) {
        auto bytes = whole;
        for (unsigned edits = 1 + random() % 4; edits > 0; --edits)
            bytes[random() % bytes.size()] = static_cast<std::uint8_t>(random());
        INFO("mutation " << i);
        load_or_refuse(folder.write("mutant.glb", bytes));
    }
}

TEST_CASE("a .glb whose JSON has a number, string or member replaced loads or is refused with an Error", "[slow]") {
    const TempFolder folder;
    const GltfBuilder builder = rich();
    const json flat = builder.finished().flatten();
    std::vector<std::string> keys;
    for (const auto& [key, value] : flat.items()) keys.push_back(key);
    const std::vector<json> replacements{-1,
                                         0,
                                         1,
                                         2,
                                         3,
                                         7,
                                         255,
                                         65536,
                                         5121,
                                         5125,
                                         5126,
                                         1e300,
                                         -1e300,
                                         4294967295U,
                                         "x",
                                         "VEC2",
                                         nullptr,
                                         true,
                                         "SCALAR",
                                         2147483647,
                                         9223372036854775807,
                                         0.5,
                                         -0.5,
                                         "",
                                         "../..",
                                         18446744073709551615U};
    std::mt19937 random(7);
    for (int i = 0; i < 3000; ++i) {
        json mutant = builder.finished();
        for (unsigned edits = 1 + random() % 3; edits > 0; --edits) {
            json::json_pointer where(keys[random() % keys.size()]);
            for (unsigned up = random() % 8; up < 2 && where.to_string().size() > 1; ++up) where.pop_back();
            json replacement = replacements[random() % replacements.size()];
            if (random() % 16 == 0) replacement = json::array({replacement, 0});
            if (random() % 16 == 0) replacement = json::object({{"index", replacement}});
            if (where.empty()) continue;
            try {
                mutant.at(where) = replacement;
            } catch (const json::exception&) {  // an earlier edit removed the place
            }
        }
        INFO("mutation " << i << ": " << mutant.dump());
        load_or_refuse(folder.write("mutant.glb", builder.glb(mutant.dump())));
    }
}
