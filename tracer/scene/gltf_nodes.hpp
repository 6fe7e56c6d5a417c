// The node hierarchy of a glTF file, flattened: which mesh and which camera stands where in the world.
#pragma once

#include <vector>

#include "tracer/scene/gltf_document.hpp"
#include "tracer/scene/gltf_transform.hpp"

namespace raycache::tracer {

struct GltfPlacement {
    int node = 0;    ///< index in the file
    int object = 0;  ///< index of the mesh or camera
    Transform to_world;
};

struct GltfNodes {
    std::vector<GltfPlacement> meshes;   ///< in the order of a depth-first walk
    std::vector<GltfPlacement> cameras;  ///< in the order of nodes in the file
};

/// Walks the default scene, or the first one, or every root where the file has no scene. Throws Error for a reference
/// out of range, a node reached twice (a cycle, or two parents), and numbers that make no transform.
GltfNodes place_gltf_nodes(const GltfDocument&, const GltfReport&);

}  // namespace raycache::tracer
