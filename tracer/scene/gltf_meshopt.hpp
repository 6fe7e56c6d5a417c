// Buffer views compressed with EXT_meshopt_compression, decoded by meshoptimizer.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "tracer/scene/gltf_report.hpp"

namespace raycache::tracer {

/// The extension's members.
struct MeshoptView {
    int buffer = 0;
    std::uint64_t byte_offset = 0, byte_length = 0;  ///< of the compressed bytes
    std::uint64_t byte_stride = 0, count = 0;        ///< of the elements
    std::string mode, filter;
};

/// `count` elements of `byte_stride` bytes. Throws Error "WHERE: …" where the members do not fit together or the bytes
/// are no such stream.
std::vector<std::uint8_t> decode_meshopt(const MeshoptView&, std::span<const std::uint8_t> compressed,
                                         const std::string& where, const GltfReport&);

}  // namespace raycache::tracer
