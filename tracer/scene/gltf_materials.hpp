// glTF materials: what the tracer keeps of them, and which images they need.
#pragma once

#include <array>
#include <vector>

#include "tracer/scene/gltf_document.hpp"
#include "tracer/scene/scene.hpp"

namespace raycache::tracer {

/// Which texture coordinates a texture is looked up by: TEXCOORD_n, transformed (KHR_texture_transform).
struct GltfTexcoords {
    int set = 0;
    std::array<double, 6> rows{1, 0, 0, 0, 1, 0};  ///< two rows of three: linear part and offset
    bool operator==(const GltfTexcoords&) const = default;

    Vec2 operator()(Vec2 stored) const;
};

struct GltfMaterials {
    std::vector<Material> materials;  ///< as in the file, then glTF's default if it is used or the only one;
                                      ///< its textures are indices into `images`
    /// Of each material, by TextureLookup::layer.
    std::vector<std::vector<GltfTexcoords>> texcoords;
    std::vector<bool> blended, double_sided;  ///< of each material, what the file says
    std::vector<int> images;                  ///< images of the file that a used material reads, each once
};

/// `used`: one per material of the file and one for glTF's default; false for those no placed primitive has, whose
/// textures are not wanted.
/// Throws Error for references out of range and values that are no colour.
GltfMaterials read_gltf_materials(const GltfDocument&, const std::vector<bool>& used, const GltfReport&);

}  // namespace raycache::tracer
