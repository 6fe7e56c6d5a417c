// Meshes compressed with KHR_draco_mesh_compression, decoded by Draco.
#pragma once

#include "tracer/scene/gltf_document.hpp"

namespace raycache::tracer {

/// Gives every primitive that has the extension accessors to its decoded vertices and indices, in place of those whose
/// bytes are in the stream. Throws Error "PATH: mesh M primitive P: …" where a stream cannot be decoded or does not
/// hold what the primitive says.
void decode_draco_primitives(GltfDocument&, const GltfReport&);

}  // namespace raycache::tracer
