// Every member that has a meaning is checked: one line says where it is, what was expected and what was found.
#include <catch2/catch.hpp>

#include "tests/tracer/gltf_files.hpp"

using namespace raycache;
using namespace raycache::tracer;
using namespace raycache::tracer::test;

namespace {

/// A file with one object of each kind, all in use.
GltfBuilder everything() {
    GltfBuilder builder;
    const int positions = builder.triangle_positions();
    const int uv = builder.floats({0, 0, 1, 0, 0, 1}, "VEC2");
    const int indices = builder.accessor(std::vector<std::uint16_t>{0, 1, 2}, "SCALAR", 5123);
    const std::uint8_t where = 2;
    const std::vector<float> what{0, 2, 0};
    builder.doc["accessors"][0]["sparse"] = {
        {"count", 1},
        {"indices", {{"bufferView", builder.view(&where, 1)}, {"componentType", 5121}, {"byteOffset", 0}}},
        {"values", {{"bufferView", builder.view(what.data(), 12)}, {"byteOffset", 0}}}};
    json material = {{"emissiveFactor", {0, 0, 0}}, {"alphaMode", "MASK"}, {"alphaCutoff", 0.5}, {"doubleSided", true}};
    material["pbrMetallicRoughness"] = {
        {"baseColorFactor", {1, 1, 1, 1}}, {"metallicFactor", 0}, {"roughnessFactor", 1}};
    material["pbrMetallicRoughness"]["baseColorTexture"] = {
        {"index", 0},
        {"texCoord", 0},
        {"extensions", {{"KHR_texture_transform", {{"offset", {0, 0}}, {"rotation", 0}, {"scale", {1, 1}}}}}}};
    material["extensions"] = {{"KHR_materials_ior", {{"ior", 1.5}}},
                              {"KHR_materials_emissive_strength", {{"emissiveStrength", 1}}}};
    builder.add("materials", material);
    builder.add("samplers", {{"wrapS", 10497}, {"wrapT", 10497}});
    builder.add("textures", {{"source", 0}, {"sampler", 0}});
    builder.add("images", {{"uri", "data:image/png;base64," + base64(png_rgb)}});
    builder.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 1.0}, {"znear", 0.1}}}});
    const int mesh = builder.mesh({{"attributes", {{"POSITION", positions}, {"TEXCOORD_0", uv}}},
                                   {"indices", indices},
                                   {"material", 0},
                                   {"mode", 4},
                                   {"targets", {{{"POSITION", builder.triangle_positions()}}}}});
    builder.doc["meshes"][0]["weights"] = {0.0};
    builder.node({{"mesh", mesh},
                  {"children", {1}},
                  {"translation", {0, 0, 0}},
                  {"rotation", {0, 0, 0, 1}},
                  {"scale", {1, 1, 1}},
                  {"weights", {0.0}}});
    builder.node(
        {{"camera", 0}, {"translation", {0, 0, 5}}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    builder.doc["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "spot"},
         {"color", {1, 1, 1}},
         {"intensity", 1},
         {"range", 9},
         {"spot", {{"innerConeAngle", 0}, {"outerConeAngle", 0.5}}}}};
    builder.doc["extensionsUsed"] = {"KHR_lights_punctual", "KHR_texture_transform", "KHR_materials_ior",
                                     "KHR_materials_emissive_strength"};
    builder.doc["scenes"] = {{{"nodes", {0}}}};
    builder.doc["scene"] = 0;
    return builder;
}

/// The message of a file whose JSON is `document`.
std::string error_with(const GltfBuilder& builder, const json& document) {
    const TempFolder folder;
    return error_of(folder.write("scene.glb", builder.glb(document.dump())));
}

/// "/nodes/0/scale" -> "nodes[0].scale", as messages write it.
std::string place_of(const json::json_pointer& pointer) {
    std::string place;
    std::string text = pointer.to_string().substr(1);
    for (std::size_t at = 0; at <= text.size();) {
        const std::size_t end = std::min(text.find('/', at), text.size());
        const std::string part = text.substr(at, end - at);
        const bool number = part.find_first_not_of("0123456789") == std::string::npos;
        place += number ? "[" + part + "]" : (place.empty() ? "" : ".") + part;
        at = end + 1;
    }
    return place;
}

}  // namespace

TEST_CASE("the file whose members are spoilt below loads without a warning") {
    const auto [scene, warnings] = load(everything());
    CHECK(scene.triangle_count() == 1);
    CHECK(scene.punctual_lights.size() == 1);
    CHECK(warnings.empty());
}

TEST_CASE("a member of another type is an error that names its place and what was found") {
    const GltfBuilder builder = everything();
    const json whole = builder.finished();
    std::size_t tried = 0;
    const json flat = whole.flatten();
    for (const auto& [key, value] : flat.items()) {
        json::json_pointer where(key);
        if (key.find("/asset") == 0 || key.find("/extensionsUsed") == 0) continue;
        for (const json& other : {json("much"), json(true), json::object({{"a", 1}}), json(nullptr)}) {
            if (value.type() == other.type()) continue;
            json spoilt = whole;
            spoilt[where] = other;
            const std::string message = error_with(builder, spoilt);
            INFO(key << " = " << other << ": " << message);
            // An array of numbers is named as a whole.
            std::string place = place_of(where);
            if (message.find(place + ": ") == std::string::npos) place = place_of(where.parent_pointer());
            CHECK(message.find("scene.glb: " + place + ": expected ") != std::string::npos);
            CHECK(message.find("found ") != std::string::npos);
            CHECK(message.find('\n') == std::string::npos);
            CHECK(message.find("damaged") == std::string::npos);
            ++tried;
        }
    }
    CHECK(tried > 200);
}

TEST_CASE("an array or object in the place of the other is an error that names it") {
    const GltfBuilder builder = everything();
    const json whole = builder.finished();
    for (const char* key : {"/nodes",
                            "/nodes/0",
                            "/nodes/0/scale",
                            "/nodes/0/children",
                            "/meshes/0/primitives",
                            "/meshes/0/primitives/0",
                            "/meshes/0/primitives/0/attributes",
                            "/meshes/0/primitives/0/targets",
                            "/accessors",
                            "/accessors/0/sparse",
                            "/accessors/0/sparse/values",
                            "/bufferViews/0",
                            "/buffers",
                            "/materials/0/pbrMetallicRoughness",
                            "/materials/0/emissiveFactor",
                            "/materials/0/pbrMetallicRoughness/baseColorTexture",
                            "/textures",
                            "/samplers/0",
                            "/scenes/0/nodes",
                            "/cameras/0/perspective",
                            "/nodes/1/extensions",
                            "/extensions/KHR_lights_punctual/lights"}) {
        const json::json_pointer where(key);
        json spoilt = whole;
        spoilt[where] = whole.at(where).is_array() ? json::object({{"a", 1}}) : json::array({1});
        const std::string message = error_with(builder, spoilt);
        INFO(message);
        CHECK(message.find(place_of(where) + ": expected ") != std::string::npos);
    }
}

TEST_CASE("offsets, counts, strides and references that are negative or no integers are errors") {
    const GltfBuilder builder = everything();
    const json whole = builder.finished();
    for (const char* key : {"/bufferViews/0/byteOffset",
                            "/bufferViews/0/byteLength",
                            "/bufferViews/0/byteStride",
                            "/bufferViews/0/buffer",
                            "/buffers/0/byteLength",
                            "/accessors/1/byteOffset",
                            "/accessors/1/count",
                            "/accessors/1/componentType",
                            "/accessors/1/bufferView",
                            "/accessors/0/sparse/count",
                            "/accessors/0/sparse/indices/byteOffset",
                            "/accessors/0/sparse/values/bufferView",
                            "/meshes/0/primitives/0/indices",
                            "/meshes/0/primitives/0/mode",
                            "/meshes/0/primitives/0/attributes/POSITION",
                            "/meshes/0/primitives/0/material",
                            "/nodes/0/mesh",
                            "/nodes/0/children/0",
                            "/nodes/1/camera",
                            "/scenes/0/nodes/0",
                            "/scene",
                            "/textures/0/source",
                            "/textures/0/sampler",
                            "/materials/0/pbrMetallicRoughness/baseColorTexture/index",
                            "/materials/0/pbrMetallicRoughness/baseColorTexture/texCoord",
                            "/samplers/0/wrapS",
                            "/nodes/1/extensions/KHR_lights_punctual/light"})
        for (const json& number : {json(-1), json(-4), json(0.5), json(1e300)}) {
            json spoilt = whole;
            spoilt[json::json_pointer(key)] = number;
            const std::string message = error_with(builder, spoilt);
            INFO(key << " = " << number << ": " << message);
            CHECK(message.find(place_of(json::json_pointer(key)) + ": expected ") != std::string::npos);
        }
}

TEST_CASE("an integer that is written with a point is an integer") {
    GltfBuilder builder = everything();
    builder.doc["accessors"][1]["count"] = 3.0;
    builder.doc["meshes"][0]["primitives"][0]["mode"] = 4.0;
    builder.doc["nodes"][0]["children"] = {1.0};
    CHECK(load(builder).scene.triangle_count() == 1);
}

TEST_CASE("a member that is missing is an error that names it") {
    const GltfBuilder builder = everything();
    const json whole = builder.finished();
    for (const char* key : {"/accessors/1/count",
                            "/accessors/1/componentType",
                            "/accessors/1/type",
                            "/accessors/0/sparse/count",
                            "/accessors/0/sparse/indices",
                            "/accessors/0/sparse/indices/bufferView",
                            "/accessors/0/sparse/indices/componentType",
                            "/accessors/0/sparse/values/bufferView",
                            "/bufferViews/0/buffer",
                            "/bufferViews/0/byteLength",
                            "/buffers/0/byteLength",
                            "/cameras/0/type",
                            "/cameras/0/perspective",
                            "/cameras/0/perspective/yfov",
                            "/cameras/0/perspective/znear",
                            "/meshes/0/primitives",
                            "/meshes/0/primitives/0/attributes",
                            "/materials/0/pbrMetallicRoughness/baseColorTexture/index",
                            "/extensions/KHR_lights_punctual/lights",
                            "/extensions/KHR_lights_punctual/lights/0/type",
                            "/nodes/1/extensions/KHR_lights_punctual/light"}) {
        const json::json_pointer where(key);
        json spoilt = whole;
        spoilt.at(where.parent_pointer()).erase(where.back());
        const std::string message = error_with(builder, spoilt);
        INFO(message);
        if (std::string(key) == "/extensions/KHR_lights_punctual/lights")
            CHECK(message.find("lights: expected ") != std::string::npos);
        else
            CHECK(message.find(place_of(where) + ": expected ") != std::string::npos);
        CHECK(message.find("found none") != std::string::npos);
    }
}

TEST_CASE("a count of 0 where a mesh is to be made of it is an error that says so") {
    for (const int accessor : {0, 2}) {
        GltfBuilder builder = everything();
        builder.doc["accessors"][0].erase("sparse");
        builder.doc["accessors"][static_cast<std::size_t>(accessor)]["count"] = 0;
        const std::string message = error_of(builder);
        INFO(message);
        CHECK(message.find("accessor " + std::to_string(accessor)) != std::string::npos);
        CHECK(message.find("expected a count of 1 or more, found 0") != std::string::npos);
    }
}

TEST_CASE("versions that are not those of the standard are refused with the words they are written in") {
    const auto error = [](const json& asset) {
        GltfBuilder builder;
        builder.place_triangle();
        builder.doc["asset"] = asset;
        return error_of(builder);
    };
    const auto mentions = [](const std::string& message, const std::string& part) {
        INFO(message);
        return message.find(part) != std::string::npos;
    };
    CHECK(mentions(error({{"version", 2.0}}), "expected a string such as \"2.0\", found the number 2.0"));
    CHECK(mentions(error({{"version", 2}}), "found the number 2"));
    CHECK(mentions(error({{"version", nullptr}}), "found the null null"));
    for (const char* version : {"2", "2.", ".0", "two", "2.0.1", " 2.0", "-2.0", ""})
        CHECK(mentions(error({{"version", version}}), "asset.version: expected a string such as"));
    CHECK(mentions(error({{"version", "3.0"}}), "expected \"2.0\", found \"3.0\""));
    CHECK(mentions(error({{"version", "2.1"}, {"minVersion", "2.1"}}),
                   "asset.minVersion: expected \"2.0\", found \"2.1\""));
    CHECK(mentions(error({{"version", "2.0"}, {"minVersion", "2.1"}}), "expected a version up to asset.version, 2.0"));
    CHECK(mentions(error({{"version", "2.0"}, {"minVersion", 2.0}}), "asset.minVersion: expected a string"));
    CHECK(mentions(error({{"generator", "x"}}), "found none"));
    CHECK(error({{"version", "2.1"}, {"minVersion", "2.0"}}) == "(no error)");
    CHECK(error({{"version", "2.0"}, {"minVersion", "2.0"}}) == "(no error)");
}

TEST_CASE("a camera without the member that its type names, or of another type, is an error that says which") {
    GltfBuilder builder = everything();
    builder.doc["cameras"][0]["type"] = "orthographic";
    CHECK(error_of(builder).find("cameras[0].orthographic: expected an object, found none") != std::string::npos);
    builder.doc["cameras"][0]["type"] = "fisheye";
    CHECK(error_of(builder).find("cameras[0].type: expected perspective, orthographic, found \"fisheye\"") !=
          std::string::npos);
}

TEST_CASE("a matrix that is not affine is an error") {
    GltfBuilder builder = everything();
    for (const char* key : {"translation", "rotation", "scale"}) builder.doc["nodes"][0].erase(key);
    builder.doc["nodes"][0]["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 2, 3, 1};
    CHECK(load(builder).scene.triangle_count() == 1);
    builder.doc["nodes"][0]["matrix"] = {1, 0, 0, 1, 0, 1, 0, 2, 0, 0, 1, 3, 0, 0, 0, 1};  // by rows
    CHECK(error_of(builder).find("stored by columns") != std::string::npos);
}
