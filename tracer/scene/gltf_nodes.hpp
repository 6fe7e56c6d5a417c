// The node hierarchy of a glTF file, flattened: which mesh, camera and light stands where in the world.
#pragma once

#include <vector>

#include "tracer/scene/gltf_document.hpp"
#include "tracer/scene/gltf_primitive.hpp"
#include "tracer/scene/gltf_transform.hpp"

namespace raycache::tracer {

struct GltfPlacement {
    int node = 0;    ///< index in the file
    int object = 0;  ///< index of the shape, camera or light
    Transform to_world;
};

struct GltfNodes {
    std::vector<GltfShape> shapes;       ///< meshes that are placed, apart where their skins or weights differ
    std::vector<GltfPlacement> meshes;   ///< of shapes, in the order of a depth-first walk; instances one by one
    std::vector<GltfPlacement> cameras;  ///< in the order of nodes in the file
    std::vector<GltfPlacement> lights;   ///< in the order of a depth-first walk
};

/// Of one node, to its parent. Throws Error for numbers that make no transform.
Transform gltf_local_transform(const GltfDocument&, int node, const GltfReport&);

/// Walks the default scene, or the first one, or every root where the file has no scene. Leaves out what
/// KHR_node_visibility hides, but for cameras. A skinned mesh stands where its joints do: its placement is the identity.
/// Throws Error for a reference out of range, a node reached twice (a cycle, or two parents), and numbers that make no
/// transform.
GltfNodes place_gltf_nodes(const GltfDocument&, const GltfReport&);

}  // namespace raycache::tracer
