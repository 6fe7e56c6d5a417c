#include "tracer/scene/gltf_document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <new>
#include <nlohmann/json.hpp>

#include "tracer/scene/gltf_uri.hpp"
#include "traces/regular_file.hpp"

namespace raycache::tracer {

namespace {

using nlohmann::json;

/// glTF itself needs about 6 levels; tinygltf and remove_extras() descend recursively.
constexpr int max_json_depth = 64;

constexpr std::array understood_extensions{"KHR_materials_emissive_strength", "KHR_materials_ior",
                                           "KHR_materials_transmission", "KHR_materials_volume",
                                           "KHR_mesh_quantization"};

/// Bytes that the JSON text takes at most, parsed by nlohmann-json and by tinygltf, for each of its characters and for
/// each object besides: "[0,0,…" makes a value of 16 bytes of two characters in either, "{}" of two a node or material.
constexpr std::uint64_t memory_of_character = 32, memory_of_object = sizeof(tinygltf::Material) + 256;

bool is_understood(const std::string& extension) {
    return std::find(understood_extensions.begin(), understood_extensions.end(), extension) !=
           understood_extensions.end();
}

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

json parse_json(std::string_view text, const GltfReport& report) {
    if (const int depth = nesting_depth(text); depth > max_json_depth)
        report.fail("JSON text", fmt::format("at most {} nested levels", max_json_depth), fmt::format("{}", depth));
    const auto objects = static_cast<std::uint64_t>(std::count(text.begin(), text.end(), '{'));
    report.charge(text.size() * memory_of_character + objects * memory_of_object, "JSON text");
    json document;
    try {
        document = json::parse(text.begin(), text.end());
    } catch (const json::exception& e) {
        report.fail("JSON text", "valid JSON", e.what());
    }
    if (!document.is_object()) report.fail("JSON text", "an object", document.type_name(), "export the scene again");
    remove_extras(document);
    return document;
}

void check_version(const json& document, const GltfReport& report) {
    std::string version;
    if (const auto asset = document.find("asset"); asset != document.end() && asset->is_object()) {
        if (const auto v = asset->find("version"); v != asset->end() && v->is_string()) version = v->get<std::string>();
    }
    if (version.empty())
        report.fail("asset.version", "\"2.0\"", "none", "this is JSON but not glTF; export the scene as glTF 2.0");
    if (!version.starts_with("2."))
        report.fail("asset.version", "\"2.0\"", fmt::format("\"{}\"", version), "convert the scene to glTF 2.0");
}

std::vector<std::string> strings_in(const json& document, const char* key) {
    std::vector<std::string> result;
    if (const auto array = document.find(key); array != document.end() && array->is_array()) {
        for (const json& item : *array)
            if (item.is_string()) result.push_back(item.get<std::string>());
    }
    return result;
}

void check_extensions(const json& document, const GltfReport& report) {
    for (const std::string& name : strings_in(document, "extensionsRequired")) {
        if (!is_understood(name))
            report.fail("extensionsRequired", fmt::format("only {}", fmt::join(understood_extensions, ", ")), name,
                        "export the scene without it");
    }
    std::string ignored;
    for (const std::string& name : strings_in(document, "extensionsUsed")) {
        if (is_understood(name)) continue;
        ignored += (ignored.empty() ? "" : ", ") + name;
    }
    if (ignored.empty()) return;
    report.warning("ignored extensions: " + ignored);
}

/// Removes the array `key` from the document and returns it; each of its items must be an object.
json take_array(json& document, const std::string& key, const GltfReport& report) {
    const auto found = document.find(key);
    if (found == document.end()) return json::array();
    json array = std::move(*found);
    document.erase(found);
    if (!array.is_array()) report.fail(key, "an array", array.type_name());
    for (std::size_t i = 0; i < array.size(); ++i)
        if (!array[i].is_object()) report.fail(fmt::format("{}[{}]", key, i), "an object", array[i].type_name());
    return array;
}

std::optional<std::string> string_member(const json& object, const char* key) {
    const auto found = object.find(key);
    if (found == object.end() || !found->is_string()) return std::nullopt;
    return found->get<std::string>();
}

std::vector<std::uint8_t> read_buffer_uri(const std::string& uri, const std::string& where, const GltfReport& report) {
    if (is_data_uri(uri)) {
        report.charge(uri.size() / 4 * 3, where);
        auto bytes = decode_data_uri(uri);
        if (!bytes) report.fail(where, "a base64 data: URI", "\"" + uri.substr(0, 40) + "…\"");
        return std::move(*bytes);
    }
    const auto path = resolve_relative_uri(report.path(), uri);
    if (!path) report.fail(where, "a relative path or a data: URI", "\"" + uri.substr(0, 200) + "\"");
    return read_regular_file(*path, where + " of " + report.path(), report.memory().get());
}

void read_buffers(const json& descriptions, GltfDocument& document, const GltfReport& report) {
    for (std::size_t i = 0; i < descriptions.size(); ++i) {
        const std::string where = fmt::format("buffer {}", i);
        const auto length_at = descriptions[i].find("byteLength");
        if (length_at == descriptions[i].end() || !length_at->is_number_unsigned())
            report.fail(where, "a byteLength of 1 or more",
                        length_at == descriptions[i].end() ? "none" : length_at->dump());
        const auto length = length_at->get<std::uint64_t>();
        std::span<const std::uint8_t> content;
        if (const auto uri = string_member(descriptions[i], "uri")) {
            document.owned_buffers.push_back(read_buffer_uri(*uri, where, report));
            content = document.owned_buffers.back();
            if (!is_data_uri(*uri)) {
                document.external_buffers.push_back(content);
                document.files.push_back(*resolve_relative_uri(report.path(), *uri));
            }
        } else if (i == 0 && document.container.bin) {
            content = *document.container.bin;
        } else {
            report.fail(where, "a URI or the file's BIN chunk", "neither");
        }
        if (content.size() < length)
            report.fail(where, fmt::format("{} bytes", length), fmt::format("{}", content.size()));
        document.buffers.push_back(content.first(length));
    }
}

void list_images(const json& descriptions, GltfDocument& document) {
    for (std::size_t i = 0; i < descriptions.size(); ++i) {
        GltfImage image;
        image.uri = string_member(descriptions[i], "uri");
        if (const auto view = descriptions[i].find("bufferView"); view != descriptions[i].end() && !image.uri)
            image.view = view->is_number_integer()
                             ? static_cast<int>(std::clamp<std::int64_t>(view->get<std::int64_t>(), -1, 0x7FFFFFFF))
                             : -1;
        const auto name = string_member(descriptions[i], "name");
        const bool file = image.uri && !is_data_uri(*image.uri);
        image.name = name ? *name : file ? *image.uri : fmt::format("image {}", i);
        document.images.push_back(std::move(image));
    }
}

}  // namespace

GltfDocument read_gltf_document(const GltfReport& report) {
    GltfDocument document;
    document.container = read_gltf_container(report);
    json description = parse_json(document.container.json, report);
    check_version(description, report);
    check_extensions(description, report);
    read_buffers(take_array(description, "buffers", report), document, report);
    list_images(take_array(description, "images", report), document);
    description.erase("animations");
    description.erase("skins");

    std::string problems;
    try {
        document.model = parse_gltf_model(description.dump(), problems);
    } catch (const json::exception& e) {
        problems = e.what();
    }
    if (!problems.empty()) report.fail("JSON text", "a glTF 2.0 description", problems);
    return document;
}

std::span<const std::uint8_t> buffer_view_bytes(const GltfDocument& document, int index, const std::string& where,
                                                const GltfReport& report) {
    const auto& views = document.model.bufferViews;
    if (index < 0 || static_cast<std::size_t>(index) >= views.size())
        report.fail(where, fmt::format("a buffer view below {}", views.size()), fmt::format("{}", index));
    const auto& view = views[static_cast<std::size_t>(index)];
    if (view.buffer < 0 || static_cast<std::size_t>(view.buffer) >= document.buffers.size())
        report.fail(fmt::format("buffer view {}", index), fmt::format("a buffer below {}", document.buffers.size()),
                    fmt::format("{}", view.buffer));
    const auto buffer = document.buffers[static_cast<std::size_t>(view.buffer)];
    if (view.byteOffset > buffer.size() || view.byteLength > buffer.size() - view.byteOffset)
        report.fail(fmt::format("buffer view {}", index),
                    fmt::format("bytes within the {} of buffer {}", buffer.size(), view.buffer),
                    fmt::format("{} from byte {}", view.byteLength, view.byteOffset));
    return buffer.subspan(view.byteOffset, view.byteLength);
}

}  // namespace raycache::tracer
