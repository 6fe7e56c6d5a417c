#include "tracer/scene/gltf_draco.hpp"

#include <draco/compression/decode.h>
#include <fmt/format.h>

#include <cstring>
#include <memory>

namespace raycache::tracer {

namespace {

constexpr const char* draco_extension = "KHR_draco_mesh_compression";
constexpr const char* decompress_draco =
    "decompress the file with `gltf-transform copy IN OUT`, or export it without Draco";

/// Adds bytes to the document and an accessor to them; returns the accessor's index.
int add_accessor(GltfDocument& document, std::vector<std::uint8_t> bytes, tinygltf::Accessor accessor) {
    tinygltf::BufferView view;
    view.buffer = 0;
    view.byteLength = bytes.size();
    document.owned_buffers.push_back(std::move(bytes));
    document.decoded_views.resize(document.model.bufferViews.size());
    document.decoded_views.emplace_back(document.owned_buffers.back());
    document.model.bufferViews.push_back(view);
    accessor.bufferView = static_cast<int>(document.model.bufferViews.size()) - 1;
    accessor.byteOffset = 0;
    accessor.sparse = {};
    document.model.accessors.push_back(std::move(accessor));
    return static_cast<int>(document.model.accessors.size()) - 1;
}

template <class T>
bool copy_values(const draco::PointAttribute& attribute, std::uint32_t points, int components,
                 std::vector<std::uint8_t>& bytes) {
    bytes.resize(std::size_t{points} * static_cast<std::size_t>(components) * sizeof(T));
    std::vector<T> value(static_cast<std::size_t>(components));
    const std::size_t size = value.size() * sizeof(T);
    for (std::uint32_t p = 0; p < points; ++p) {
        const auto index = attribute.mapped_index(draco::PointIndex(p));
        if (!attribute.ConvertValue<T>(index, static_cast<std::int8_t>(components), value.data())) return false;
        std::memcpy(bytes.data() + p * size, value.data(), size);
    }
    return true;
}

bool copy_values(const draco::PointAttribute& attribute, std::uint32_t points, const tinygltf::Accessor& accessor,
                 std::vector<std::uint8_t>& bytes) {
    const int components = tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type));
    if (components < 1 || components > 4) return false;
    switch (accessor.componentType) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
            return copy_values<std::int8_t>(attribute, points, components, bytes);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return copy_values<std::uint8_t>(attribute, points, components, bytes);
        case TINYGLTF_COMPONENT_TYPE_SHORT:
            return copy_values<std::int16_t>(attribute, points, components, bytes);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return copy_values<std::uint16_t>(attribute, points, components, bytes);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
            return copy_values<std::uint32_t>(attribute, points, components, bytes);
        case TINYGLTF_COMPONENT_TYPE_FLOAT:
            return copy_values<float>(attribute, points, components, bytes);
        default:
            return false;
    }
}

std::unique_ptr<draco::Mesh> decode_stream(std::span<const std::uint8_t> bytes, const std::string& where,
                                           const GltfReport& report) {
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    draco::Decoder decoder;
    auto mesh = decoder.DecodeMeshFromBuffer(&buffer);
    if (!mesh.ok())
        report.fail(where, fmt::format("a mesh compressed with Draco ({})", draco_extension),
                    fmt::format("{} bytes that Draco cannot decode ({})", bytes.size(), mesh.status().error_msg()),
                    decompress_draco);
    return std::move(mesh).value();
}

void decode_primitive(GltfDocument& document, tinygltf::Primitive& primitive, const tinygltf::Value& packed,
                      const std::string& where, const GltfReport& report) {
    const auto bytes = buffer_view_bytes(document, packed.Get("bufferView").GetNumberAsInt(), where, report);
    const auto mesh = decode_stream(bytes, where, report);
    const std::uint32_t points = mesh->num_points(), faces = mesh->num_faces();
    report.charge(std::uint64_t{points} * 64 + std::uint64_t{faces} * 24, where);

    const tinygltf::Value& ids = packed.Get("attributes");
    for (const std::string& name : ids.Keys()) {
        const auto named = primitive.attributes.find(name);
        if (named == primitive.attributes.end())
            report.fail(fmt::format("{} {}", where, name), "an attribute of the primitive", "one of the stream alone");
        const int id = ids.Get(name).GetNumberAsInt();
        const auto* attribute = mesh->GetAttributeByUniqueId(static_cast<std::uint32_t>(id));
        tinygltf::Accessor accessor = document.model.accessors[static_cast<std::size_t>(named->second)];
        std::vector<std::uint8_t> values;
        if (!attribute || !copy_values(*attribute, points, accessor, values))
            report.fail(fmt::format("{} {}", where, name), fmt::format("attribute {} of the Draco stream", id),
                        attribute ? "one of another type" : "none", decompress_draco);
        accessor.count = points;
        named->second = add_accessor(document, std::move(values), std::move(accessor));
    }

    std::vector<std::uint8_t> indices(std::size_t{faces} * 3 * sizeof(std::uint32_t));
    for (std::uint32_t f = 0; f < faces; ++f) {
        const auto& face = mesh->face(draco::FaceIndex(f));
        const std::uint32_t corners[3] = {face[0].value(), face[1].value(), face[2].value()};
        std::memcpy(indices.data() + f * sizeof corners, corners, sizeof corners);
    }
    tinygltf::Accessor accessor;
    accessor.componentType = TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
    accessor.type = TINYGLTF_TYPE_SCALAR;
    accessor.count = std::size_t{faces} * 3;
    primitive.indices = add_accessor(document, std::move(indices), std::move(accessor));
    primitive.mode = TINYGLTF_MODE_TRIANGLES;  // whatever it was: Draco's faces are triangles
}

}  // namespace

void decode_draco_primitives(GltfDocument& document, const GltfReport& report) {
    for (std::size_t m = 0; m < document.model.meshes.size(); ++m) {
        auto& primitives = document.model.meshes[m].primitives;
        for (std::size_t p = 0; p < primitives.size(); ++p) {
            const auto packed = primitives[p].extensions.find(draco_extension);
            if (packed == primitives[p].extensions.end()) continue;
            const tinygltf::Value description = packed->second;
            decode_primitive(document, primitives[p], description, fmt::format("mesh {} primitive {}", m, p), report);
        }
    }
}

}  // namespace raycache::tracer
