// Bounds-checked reading of glTF accessors: any component type, stride, normalisation and sparse substitution.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "tracer/scene/gltf_document.hpp"
#include "tracer/vec.hpp"

namespace raycache::tracer {

class GltfAccessor {
public:
    /// Validates everything that reading any element needs. Throws Error naming the accessor and `what` it is for.
    /// `components` is the number an element must have, 0: 3 or 4; `is_index` asks for unsigned integers as well.
    /// The document must outlive the accessor.
    GltfAccessor(const GltfDocument&, int index, int components, bool is_index, const std::string& what,
                 const GltfReport&);

    std::uint64_t count() const { return count_; }
    Vec2 vec2(std::uint64_t element) const;
    Vec3 vec3(std::uint64_t element) const;
    std::array<float, 4> vec4(std::uint64_t element) const;  ///< of three components: 1 is the fourth
    float number(std::uint64_t element, int component) const;
    std::uint32_t integer(std::uint64_t element, int component = 0) const;
    /// As the file says, 1 to 16.
    int components() const { return components_; }

private:
    const std::uint8_t* at(std::uint64_t element) const;
    float component(const std::uint8_t* element, int i) const;
    void read_sparse(const GltfDocument&, const tinygltf::Accessor&, const std::string& where, const GltfReport&);

    const std::uint8_t* data_ = nullptr;  ///< nullptr: all elements are zero unless sparse ones replace them
    std::uint64_t count_ = 0, stride_ = 0;
    int component_type_ = 0, component_bytes_ = 0, components_ = 0;
    bool normalized_ = false;
    std::vector<std::pair<std::uint32_t, const std::uint8_t*>> sparse_;  ///< by element
};

}  // namespace raycache::tracer
