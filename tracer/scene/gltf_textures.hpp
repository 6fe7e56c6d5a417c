// The images of a glTF file that materials use: found, read, and decoded on all cores.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "tracer/scene/gltf_document.hpp"
#include "tracer/scene/scene.hpp"

namespace raycache::tracer {

/// An image as it is stored. Without bytes it could not be had, and `problem` says why.
struct GltfImageBytes {
    std::string name;
    std::span<const std::uint8_t> bytes;
    std::vector<std::uint8_t> owned;  ///< behind `bytes` unless they lie in a buffer
    std::string file;                 ///< its own, if it has one
    std::string problem;
};

/// Reads the given images of the file. Never throws Error for one that is missing or damaged.
std::vector<GltfImageBytes> read_gltf_images(const GltfDocument&, const std::vector<int>& images, const GltfReport&);

/// Decodes in parallel; the result does not depend on the number of threads. `materials` refer to `images` and are
/// made to refer to the result; where an image is missing, cannot be decoded or is too large they lose their texture,
/// and one warning counts such images.
std::vector<Texture> decode_gltf_textures(const std::vector<GltfImageBytes>& images, std::vector<Material>& materials,
                                          const GltfReport&);

}  // namespace raycache::tracer
