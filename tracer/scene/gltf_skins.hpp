// Skinned meshes at rest: where the joints of a skin put a vertex (glTF 2.0 specification, 3.7.3).
#pragma once

#include <string>
#include <vector>

#include "tracer/scene/gltf_accessor.hpp"
#include "tracer/scene/gltf_document.hpp"
#include "tracer/scene/gltf_transform.hpp"

namespace raycache::tracer {

struct GltfSkin {
    std::vector<Transform> joints;  ///< from the mesh's space, by way of the joint's, to the world
};

/// Of every skin of the file. Throws Error for references out of range and too few inverse bind matrices.
std::vector<GltfSkin> read_gltf_skins(const GltfDocument&, const GltfReport&);

/// Moves vertex `v`, and its normal if there is one, to the world, by weights that are made to add up to 1. Leaves a
/// vertex without weights where it is. Throws Error "WHERE: …" for a joint that the skin does not have.
void bend_vertex(const GltfSkin&, const std::vector<GltfAccessor>& joints, const std::vector<GltfAccessor>& weights,
                 std::uint64_t v, Vec3& position, Vec3* normal, const std::string& where, const GltfReport&);

}  // namespace raycache::tracer
