#include "tracer/scene/gltf_json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "tracer/scene/gltf_model.hpp"

namespace raycache::tracer {

namespace {

using nlohmann::json;

/// glTF itself needs about 6 levels; tinygltf and remove_extras() descend recursively.
constexpr int max_json_depth = 64;

/// Bytes that the JSON text takes at most, parsed by nlohmann-json and by tinygltf, for each of its characters and for
/// each object besides: "[0,0,…" makes a value of 16 bytes of two characters in either, "{}" of two a node or material.
constexpr std::uint64_t memory_of_character = 32, memory_of_object = sizeof(tinygltf::Material) + 256;

/// How deep brackets nest outside strings. The text need not be valid.
int nesting_depth(std::string_view text) {
    int depth = 0, deepest = 0;
    bool in_string = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (in_string) {
            if (c == '\\') ++i;
            if (c == '"') in_string = false;
            continue;
        }
        if (c == '"') in_string = true;
        if (c == '{' || c == '[') deepest = std::max(deepest, ++depth);
        if (c == '}' || c == ']') --depth;
    }
    return deepest;
}

/// `extras` may hold anything; tinygltf would make large structures of it.
void remove_extras(json& value) {
    if (value.is_object()) value.erase("extras");
    if (value.is_structured())
        for (json& item : value) remove_extras(item);
}

/// "2.1" of digits, a dot and digits.
std::optional<std::pair<unsigned, unsigned>> parse_version(const std::string& text) {
    const auto dot = text.find('.');
    constexpr std::size_t longest = 9;
    if (dot == std::string::npos || text.size() > longest || dot == 0 || dot + 1 == text.size()) return std::nullopt;
    for (std::size_t i = 0; i < text.size(); ++i)
        if (i != dot && (text[i] < '0' || text[i] > '9')) return std::nullopt;
    return std::pair{static_cast<unsigned>(std::stoul(text.substr(0, dot))),
                     static_cast<unsigned>(std::stoul(text.substr(dot + 1)))};
}

/// Reflectance of a dielectric head on -> its index of refraction.
double ior_of(double reflectance) {
    const double root = std::sqrt(std::clamp(reflectance, 0.0, 0.9));
    return (1 + root) / (1 - root);
}

/// A material of KHR_materials_pbrSpecularGlossiness in terms of base colour, metal and roughness: coloured bright
/// specular over a black body is metal, any other a dielectric of that reflectance.
void rewrite_glossiness(json& material) {
    const json gloss = material["extensions"]["KHR_materials_pbrSpecularGlossiness"];
    const auto diffuse = gloss.value("diffuseFactor", std::vector<double>{1, 1, 1, 1});
    const auto specular = gloss.value("specularFactor", std::vector<double>{1, 1, 1});
    const bool textured = gloss.contains("specularGlossinessTexture") || gloss.contains("diffuseTexture");
    const double brightest = *std::max_element(specular.begin(), specular.end());
    const double body = *std::max_element(diffuse.begin(), diffuse.begin() + 3);
    constexpr double dielectric = 0.2, black = 0.04;
    const bool metal = !textured && brightest > dielectric && body <= black;
    json pbr = {{"metallicFactor", metal ? 1 : 0}, {"roughnessFactor", 1 - gloss.value("glossinessFactor", 1.0)}};
    pbr["baseColorFactor"] = metal ? std::vector<double>{specular[0], specular[1], specular[2], diffuse[3]} : diffuse;
    if (gloss.contains("diffuseTexture")) pbr["baseColorTexture"] = gloss["diffuseTexture"];
    material["pbrMetallicRoughness"] = pbr;
    if (!metal && !gloss.contains("specularGlossinessTexture") && !material["extensions"].contains("KHR_materials_ior"))
        material["extensions"]["KHR_materials_ior"] = {{"ior", ior_of(std::min(brightest, dielectric))}};
}

}  // namespace

json parse_gltf_json(std::string_view text, const GltfReport& report) {
    if (const int depth = nesting_depth(text); depth > max_json_depth)
        report.fail("JSON text", fmt::format("at most {} nested levels", max_json_depth), fmt::format("{}", depth));
    const auto objects = static_cast<std::uint64_t>(std::count(text.begin(), text.end(), '{'));
    report.charge(text.size() * memory_of_character + objects * memory_of_object, "JSON text");
    json document;
    try {
        document = json::parse(text.begin(), text.end());
    } catch (const json::exception& e) {
        report.fail("JSON text", "valid JSON", e.what(), "the file is cut short or damaged: copy or export it again");
    }
    if (!document.is_object()) report.fail("JSON text", "an object", document.type_name(), "export the scene again");
    remove_extras(document);
    return document;
}

void check_gltf_version(const json& document, const GltfReport& report) {
    const auto found_text = [](const json& value) {
        return value.is_string()
                   ? value.dump(-1, ' ', false, json::error_handler_t::replace)
                   : fmt::format("the {} {}", value.type_name(),
                                 value.dump(-1, ' ', false, json::error_handler_t::replace).substr(0, 40));
    };
    const auto asset = document.find("asset");
    if (asset == document.end() || !asset->is_object() || !asset->contains("version"))
        report.fail("asset.version", "\"2.0\"", "none", "this is JSON but not glTF; export the scene as glTF 2.0");
    const auto read = [&](const char* key) {
        const json& value = (*asset)[key];
        const auto version = value.is_string() ? parse_version(value.get<std::string>()) : std::nullopt;
        if (!version)
            report.fail(fmt::format("asset.{}", key), "a string such as \"2.0\"", found_text(value),
                        "write it as the string \"2.0\", if it is glTF 2.0");
        return *version;
    };
    const auto version = read("version");
    if (version.first != 2)
        report.fail("asset.version", "\"2.0\"", found_text((*asset)["version"]), "convert the scene to glTF 2.0");
    if (!asset->contains("minVersion")) return;
    const auto least = read("minVersion");
    if (least > version)
        report.fail("asset.minVersion",
                    fmt::format("a version up to asset.version, {}.{}", version.first, version.second),
                    found_text((*asset)["minVersion"]));
    if (least > std::pair{2U, 0U})
        report.fail("asset.minVersion", "\"2.0\"", found_text((*asset)["minVersion"]),
                    "the file asks for a later glTF than raycache reads; export it as glTF 2.0");
}

void rewrite_gltf_extensions(json& document) {
    for (json& material : document["materials"]) {
        const auto extensions = material.find("extensions");
        if (extensions == material.end() || material.contains("pbrMetallicRoughness")) continue;
        if (extensions->contains("KHR_materials_pbrSpecularGlossiness")) rewrite_glossiness(material);
    }
    for (json& texture : document["textures"]) {
        const auto webp = json::json_pointer("/extensions/EXT_texture_webp/source");
        if (texture.contains(webp)) texture["source"] = texture.at(webp);
    }
    for (const char* section : {"materials", "textures"})
        if (document[section].is_null()) document.erase(section);
}

}  // namespace raycache::tracer
