// Instances of one node's mesh (EXT_mesh_gpu_instancing).
#pragma once

#include <string>
#include <vector>

#include "tracer/scene/gltf_document.hpp"
#include "tracer/scene/gltf_transform.hpp"

namespace raycache::tracer {

/// From each instance to the node. Throws Error "WHERE: …" where attributes are of other types or differ in length.
std::vector<Transform> read_gltf_instances(const GltfDocument&, const tinygltf::Value& extension,
                                           const std::string& where, const GltfReport&);

}  // namespace raycache::tracer
