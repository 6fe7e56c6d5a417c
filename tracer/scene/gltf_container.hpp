// The outer shell of a glTF file: where its JSON text and its binary chunk lie.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tracer/scene/gltf_report.hpp"

namespace raycache::tracer {

struct GltfContainer {
    std::vector<std::uint8_t> bytes;                   ///< the whole file
    std::string_view json;                             ///< into `bytes`
    std::optional<std::span<const std::uint8_t>> bin;  ///< into `bytes`: the BIN chunk of a .glb
};

/// Reads the file and tells .glb from .gltf by its first bytes, not by its name. Throws Error if it is missing, empty,
/// truncated, another version or something else.
GltfContainer read_gltf_container(const GltfReport&);

}  // namespace raycache::tracer
