// Placed meshes -> one list of triangles in the scene's frame.
#pragma once

#include <vector>

#include "tracer/scene/gltf_nodes.hpp"
#include "tracer/scene/gltf_primitive.hpp"
#include "tracer/scene/scene.hpp"

namespace raycache::tracer {

/// A ray tracer's triangle ids leave room for a flag and a "none".
constexpr std::uint64_t max_scene_triangles = (1ULL << 30) - 2;

/// Throws Error if the placements make more than `max_scene_triangles`; charges the report's budget with what they and
/// the decoded primitives take. `sources[s]` are the primitives of shape s. Decodes nothing: call it before
/// decode_gltf_primitive().
void check_scene_size(const std::vector<GltfPlacement>&, const std::vector<std::vector<GltfPrimitiveSource>>& sources,
                      const GltfReport&);

/// Appends every placement of every primitive to `scene`, in its frame. A transform with a negative determinant turns
/// the triangles round, so that their fronts stay fronts. Normals, texture coordinates and colours are filled for all
/// vertices if any placed primitive has them.
void flatten_gltf_meshes(const std::vector<GltfPlacement>&, const std::vector<std::vector<GltfPrimitive>>& meshes,
                         Scene& scene, GltfLosses&);

}  // namespace raycache::tracer
