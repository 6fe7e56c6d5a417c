// glTF materials: what the tracer keeps of them, and which images they need.
#pragma once

#include <vector>

#include "tracer/scene/gltf_document.hpp"
#include "tracer/scene/scene.hpp"

namespace raycache::tracer {

struct GltfMaterials {
    std::vector<Material> materials;  ///< as in the file, then glTF's default if it is used or the only one;
                                      ///< its textures are indices into `images`
    std::vector<int> texcoord_set;    ///< one per material: n of TEXCOORD_n, or -1 without a texture
    std::vector<int> images;          ///< images of the file that a used material reads, each once
};

/// `used`: one per material of the file and one for glTF's default; false for those no placed primitive has, whose
/// textures are not wanted.
/// Throws Error for references out of range and values that are no colour.
GltfMaterials read_gltf_materials(const GltfDocument&, const std::vector<bool>& used, const GltfReport&);

}  // namespace raycache::tracer
