#include "tracer/scene/gltf_accessor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

namespace raycache::tracer {

namespace {

/// An accessor without a buffer view takes no bytes in the file, so its count alone must not decide what we allocate.
constexpr std::uint64_t max_elements_without_view = 1U << 24;

/// 0 for a type that glTF does not allow.
int bytes_of(int component_type) {
    switch (component_type) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return 1;
        case TINYGLTF_COMPONENT_TYPE_SHORT:
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return 2;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
        case TINYGLTF_COMPONENT_TYPE_FLOAT:
            return 4;
        default:
            return 0;
    }
}

bool is_index_type(int component_type) {
    return component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
           component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
           component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
}

template <class T>
T load(const std::uint8_t* bytes) {
    T value;
    std::memcpy(&value, bytes, sizeof value);
    return value;
}

std::uint32_t load_integer(const std::uint8_t* bytes, int component_bytes) {
    return component_bytes == 1   ? *bytes
           : component_bytes == 2 ? load<std::uint16_t>(bytes)
                                  : load<std::uint32_t>(bytes);
}

/// Throws unless `count` elements of `element_bytes`, `stride` apart, lie within `bytes` from `offset` on.
void check_extent(std::size_t bytes, std::uint64_t offset, std::uint64_t count, std::uint64_t stride,
                  std::uint64_t element_bytes, const std::string& where, const GltfReport& report) {
    if (count == 0) return;
    if (offset <= bytes && element_bytes <= bytes - offset && count - 1 <= (bytes - offset - element_bytes) / stride)
        return;
    report.fail(where, fmt::format("elements within its buffer view of {} bytes", bytes),
                fmt::format("{} elements of {} bytes every {} from byte {}", count, element_bytes, stride, offset),
                GltfReport::damaged);
}

}  // namespace

GltfAccessor::GltfAccessor(const GltfDocument& document, int index, int components, bool is_index,
                           const std::string& what, const GltfReport& report)
    : components_(components) {
    const auto& accessors = document.model.accessors;
    if (index < 0 || static_cast<std::size_t>(index) >= accessors.size())
        report.fail(what, fmt::format("an accessor below {}", accessors.size()), fmt::format("{}", index));
    const tinygltf::Accessor& accessor = accessors[static_cast<std::size_t>(index)];
    const std::string where = fmt::format("accessor {} ({})", index, what);
    const int found_components = tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type));
    if (components == 0 && (found_components == 3 || accessor.type == TINYGLTF_TYPE_VEC4))
        components = components_ = found_components;
    const bool square = components == 16;  // matrices of this size have no padding
    const bool kind_fits = square ? accessor.type == TINYGLTF_TYPE_MAT4
                                  : accessor.type <= TINYGLTF_TYPE_VEC4 || accessor.type == TINYGLTF_TYPE_SCALAR;
    component_type_ = accessor.componentType;
    component_bytes_ = bytes_of(component_type_);
    if (component_bytes_ == 0 || found_components != components || !kind_fits ||
        (is_index && !is_index_type(component_type_)))
        report.fail(where,
                    is_index && components == 1 ? "SCALAR of unsigned byte, short or int"
                    : square                    ? "MAT4 of float"
                    : components == 0
                        ? "VEC3 or VEC4 of byte, short, unsigned int or float"
                        : fmt::format("VEC{} of {}byte, short, {}", components, is_index ? "unsigned " : "",
                                      is_index ? "int" : "unsigned int or float"),
                    fmt::format("{} components of type {}", found_components, component_type_));
    normalized_ = accessor.normalized;
    count_ = accessor.count;
    const auto element_bytes = static_cast<std::uint64_t>(component_bytes_ * components);
    stride_ = element_bytes;
    if (accessor.bufferView >= 0) {
        const auto bytes = buffer_view_bytes(document, accessor.bufferView, where, report);
        const auto& view = document.model.bufferViews[static_cast<std::size_t>(accessor.bufferView)];
        if (view.byteStride != 0) stride_ = view.byteStride;
        if (stride_ < element_bytes)
            report.fail(where, fmt::format("a byteStride of at least {}", element_bytes), fmt::format("{}", stride_));
        check_extent(bytes.size(), accessor.byteOffset, count_, stride_, element_bytes, where, report);
        data_ = count_ > 0 ? bytes.data() + accessor.byteOffset : nullptr;
    } else if (count_ > max_elements_without_view) {
        report.fail(where, fmt::format("at most {} elements without a buffer view", max_elements_without_view),
                    fmt::format("{}", count_));
    }
    if (accessor.sparse.isSparse) read_sparse(document, accessor, where, report);
}

void GltfAccessor::read_sparse(const GltfDocument& document, const tinygltf::Accessor& accessor,
                               const std::string& where, const GltfReport& report) {
    const auto& sparse = accessor.sparse;
    if (sparse.count < 0 || static_cast<std::uint64_t>(sparse.count) > count_)
        report.fail(where, fmt::format("between 0 and {} sparse elements", count_),
                    sparse.count < 0 ? "a number below 0 or beyond 2147483647" : fmt::format("{}", sparse.count));
    const auto sparse_count = static_cast<std::uint64_t>(sparse.count);
    if (!is_index_type(sparse.indices.componentType))
        report.fail(where, "sparse indices of unsigned byte, short or int",
                    fmt::format("type {}", sparse.indices.componentType));
    if (sparse.indices.byteOffset < 0 || sparse.values.byteOffset < 0)
        report.fail(where, "sparse byte offsets of 0 or more", "a negative one");
    const auto element_bytes = static_cast<std::uint64_t>(component_bytes_ * components_);
    const int index_bytes = bytes_of(sparse.indices.componentType);
    const auto stride = static_cast<std::uint64_t>(index_bytes);
    const auto indices = buffer_view_bytes(document, sparse.indices.bufferView, where, report);
    const auto values = buffer_view_bytes(document, sparse.values.bufferView, where, report);
    const auto indices_offset = static_cast<std::uint64_t>(sparse.indices.byteOffset);
    const auto values_offset = static_cast<std::uint64_t>(sparse.values.byteOffset);
    check_extent(indices.size(), indices_offset, sparse_count, stride, stride, where + " sparse indices", report);
    check_extent(values.size(), values_offset, sparse_count, element_bytes, element_bytes, where + " sparse values",
                 report);
    report.charge(sparse_count * sizeof(sparse_.front()), where + " sparse elements");
    sparse_.reserve(sparse_count);
    for (std::uint64_t i = 0; i < sparse_count; ++i) {
        const std::uint32_t element = load_integer(indices.data() + indices_offset + i * stride, index_bytes);
        if (element >= count_ || (i > 0 && element <= sparse_.back().first))
            report.fail(where, fmt::format("increasing sparse indices below {}", count_),
                        fmt::format("{} at position {}", element, i));
        sparse_.emplace_back(element, values.data() + values_offset + i * element_bytes);
    }
}

const std::uint8_t* GltfAccessor::at(std::uint64_t element) const {
    if (!sparse_.empty()) {
        const auto found = std::lower_bound(sparse_.begin(), sparse_.end(), element,
                                            [](const auto& entry, std::uint64_t e) { return entry.first < e; });
        if (found != sparse_.end() && found->first == element) return found->second;
    }
    return data_ ? data_ + element * stride_ : nullptr;
}

float GltfAccessor::component(const std::uint8_t* element, int i) const {
    if (!element) return 0;
    const std::uint8_t* bytes = element + i * component_bytes_;
    switch (component_type_) {
        case TINYGLTF_COMPONENT_TYPE_FLOAT:
            return load<float>(bytes);
        case TINYGLTF_COMPONENT_TYPE_BYTE: {
            const auto value = static_cast<float>(load<std::int8_t>(bytes));
            return normalized_ ? std::max(value / 127.0F, -1.0F) : value;
        }
        case TINYGLTF_COMPONENT_TYPE_SHORT: {
            const auto value = static_cast<float>(load<std::int16_t>(bytes));
            return normalized_ ? std::max(value / 32767.0F, -1.0F) : value;
        }
        default: {
            const std::uint32_t value = load_integer(bytes, component_bytes_);
            const float largest = component_bytes_ == 1 ? 255.0F : component_bytes_ == 2 ? 65535.0F : 4294967296.0F;
            return normalized_ ? static_cast<float>(value) / largest : static_cast<float>(value);
        }
    }
}

Vec2 GltfAccessor::vec2(std::uint64_t element) const {
    const std::uint8_t* bytes = at(element);
    return {component(bytes, 0), component(bytes, 1)};
}

Vec3 GltfAccessor::vec3(std::uint64_t element) const {
    const std::uint8_t* bytes = at(element);
    return {component(bytes, 0), component(bytes, 1), component(bytes, 2)};
}

std::array<float, 4> GltfAccessor::vec4(std::uint64_t element) const {
    const std::uint8_t* bytes = at(element);
    return {component(bytes, 0), component(bytes, 1), component(bytes, 2), components_ == 3 ? 1 : component(bytes, 3)};
}

float GltfAccessor::number(std::uint64_t element, int i) const { return component(at(element), i); }

std::uint32_t GltfAccessor::integer(std::uint64_t element, int i) const {
    const std::uint8_t* bytes = at(element);
    return bytes ? load_integer(bytes + i * component_bytes_, component_bytes_) : 0;
}

}  // namespace raycache::tracer
