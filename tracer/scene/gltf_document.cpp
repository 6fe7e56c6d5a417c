#include "tracer/scene/gltf_document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "tracer/scene/gltf_draco.hpp"
#include "tracer/scene/gltf_extensions.hpp"
#include "tracer/scene/gltf_json.hpp"
#include "tracer/scene/gltf_meshopt.hpp"
#include "tracer/scene/gltf_schema.hpp"
#include "tracer/scene/gltf_uri.hpp"
#include "traces/regular_file.hpp"

namespace raycache::tracer {

namespace {

using nlohmann::json;

constexpr const char* meshopt = "EXT_meshopt_compression";

/// Removes the array `key` from the document and returns it.
json take_array(json& document, const std::string& key) {
    const auto found = document.find(key);
    if (found == document.end()) return json::array();
    json array = std::move(*found);
    document.erase(found);
    return array;
}

std::optional<std::string> string_member(const json& object, const char* key) {
    const auto found = object.find(key);
    if (found == object.end() || !found->is_string()) return std::nullopt;
    return found->get<std::string>();
}

/// Of the file that a URI names; "" of a data: URI.
std::string file_of_uri(const std::string& uri, const std::string& where, const GltfReport& report) {
    const UriFile file = find_uri_file(report.path(), uri);
    const std::string shown = "\"" + uri.substr(0, 200) + "\"";
    if (file.path.empty()) report.fail(where, "a relative path or a data: URI", shown, file.remedy);
    if (!file.remedy.empty() && !file.exists) report.fail(where, "a file beside the scene", shown, file.remedy);
    if (!file.note.empty()) report.warning(fmt::format("{}: the URI {} {}", where, shown, file.note));
    return file.path;
}

void read_buffer_uri(const std::string& uri, const std::string& where, GltfDocument& document,
                     const GltfReport& report) {
    if (is_data_uri(uri)) {
        report.charge(uri.size() / 4 * 3, where);
        auto bytes = decode_data_uri(uri);
        if (!bytes) report.fail(where, "a base64 data: URI", "\"" + uri.substr(0, 40) + "…\"");
        document.owned_buffers.push_back(std::move(*bytes));
        return;
    }
    const std::string path = file_of_uri(uri, where, report);
    document.owned_buffers.push_back(read_regular_file(path, where + " of " + report.path(), report.memory().get()));
    document.external_buffers.push_back(document.owned_buffers.back());
    document.files.push_back(path);
}

void read_buffers(const json& descriptions, GltfDocument& document, const GltfReport& report) {
    for (std::size_t i = 0; i < descriptions.size(); ++i) {
        const std::string where = fmt::format("buffer {}", i);
        const auto length = descriptions[i]["byteLength"].get<std::uint64_t>();
        const auto extensions = descriptions[i].find("extensions");
        std::span<const std::uint8_t> content;
        if (const auto uri = string_member(descriptions[i], "uri"); uri && !uri->empty()) {
            read_buffer_uri(*uri, where, document, report);
            content = document.owned_buffers.back();
        } else if (extensions != descriptions[i].end() && extensions->contains(meshopt)) {
            document.buffers.emplace_back();  // holds nothing: every view of it is compressed
            continue;
        } else if (i == 0 && document.container.bin) {
            content = *document.container.bin;
        } else {
            report.fail(where, "a URI or the file's BIN chunk", "neither",
                        "a part of the scene was left behind: export it again");
        }
        if (content.size() < length)
            report.fail(where, fmt::format("{} bytes", length), fmt::format("{}", content.size()), GltfReport::damaged);
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

/// tinygltf refuses indices without a buffer view, which sparse accessors and compressed meshes have, and skins without
/// matrices: gives each object of the section the index 0 as what it lacks. Returns which.
std::vector<std::size_t> lend_index(json& description, const char* section, const char* member) {
    std::vector<std::size_t> lent;
    const auto objects = description.find(section);
    if (objects == description.end()) return lent;
    for (std::size_t i = 0; i < objects->size(); ++i) {
        if ((*objects)[i].contains(member)) continue;
        (*objects)[i][member] = 0;
        lent.push_back(i);
    }
    return lent;
}

void decompress_views(const json& views, GltfDocument& document, const GltfReport& report) {
    document.decoded_views.resize(document.model.bufferViews.size());
    for (std::size_t i = 0; i < views.size(); ++i) {
        const auto extensions = views[i].find("extensions");
        if (extensions == views[i].end() || !extensions->contains(meshopt)) continue;
        const json& packed = (*extensions)[meshopt];
        MeshoptView view{packed["buffer"],
                         packed.value("byteOffset", std::uint64_t{0}),
                         packed["byteLength"],
                         packed["byteStride"],
                         packed["count"],
                         packed["mode"],
                         packed.value("filter", "NONE")};
        const std::string where = fmt::format("bufferViews[{}].extensions.{}", i, meshopt);
        const auto compressed =
            bytes_of_buffer(document, view.buffer, view.byte_offset, view.byte_length, where, report);
        document.owned_buffers.push_back(decode_meshopt(view, compressed, where, report));
        document.decoded_views[i] = document.owned_buffers.back();
        document.model.bufferViews[i].byteLength = document.owned_buffers.back().size();
    }
}

}  // namespace

GltfDocument read_gltf_document(const GltfReport& report) {
    GltfDocument document;
    document.container = read_gltf_container(report);
    json description = parse_gltf_json(document.container.json, report);
    check_gltf_version(description, report);
    check_gltf_schema(description, report);
    check_gltf_extensions(description, report);
    rewrite_gltf_extensions(description);
    const json buffers = take_array(description, "buffers");
    read_buffers(buffers, document, report);
    list_images(take_array(description, "images"), document);
    if (const auto found = description.find("animations"); found != description.end() && !found->empty())
        report.warning(fmt::format("its {} animations are not played: everything is where the file puts it at rest",
                                   found->size()));
    description.erase("animations");
    const std::vector<std::size_t> without_view = lend_index(description, "accessors", "bufferView");
    const std::vector<std::size_t> without_matrices = lend_index(description, "skins", "inverseBindMatrices");

    std::string problems;
    try {
        document.model = parse_gltf_model(description.dump(), problems);
    } catch (const json::exception& e) {
        problems = e.what();
    }
    if (!problems.empty()) report.fail("JSON text", "a glTF 2.0 description", problems);
    for (const std::size_t accessor : without_view) document.model.accessors[accessor].bufferView = -1;
    for (const std::size_t skin : without_matrices) document.model.skins[skin].inverseBindMatrices = -1;
    decompress_views(take_array(description, "bufferViews"), document, report);
    decode_draco_primitives(document, report);
    return document;
}

std::span<const std::uint8_t> bytes_of_buffer(const GltfDocument& document, int index, std::uint64_t offset,
                                              std::uint64_t length, const std::string& where,
                                              const GltfReport& report) {
    if (index < 0 || static_cast<std::size_t>(index) >= document.buffers.size())
        report.fail(where, fmt::format("a buffer below {}", document.buffers.size()), fmt::format("{}", index));
    const auto buffer = document.buffers[static_cast<std::size_t>(index)];
    if (offset > buffer.size() || length > buffer.size() - offset)
        report.fail(where, fmt::format("bytes within the {} of buffer {}", buffer.size(), index),
                    fmt::format("{} from byte {}", length, offset), GltfReport::damaged);
    return buffer.subspan(offset, length);
}

std::span<const std::uint8_t> buffer_view_bytes(const GltfDocument& document, int index, const std::string& where,
                                                const GltfReport& report) {
    const auto& views = document.model.bufferViews;
    if (index < 0 || static_cast<std::size_t>(index) >= views.size())
        report.fail(where, fmt::format("a buffer view below {}", views.size()), fmt::format("{}", index));
    const auto i = static_cast<std::size_t>(index);
    if (i < document.decoded_views.size() && document.decoded_views[i].data()) return document.decoded_views[i];
    return bytes_of_buffer(document, views[i].buffer, views[i].byteOffset, views[i].byteLength,
                           fmt::format("buffer view {}", index), report);
}

}  // namespace raycache::tracer
