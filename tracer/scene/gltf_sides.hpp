// What doubleSided would hide. A path tracer's surfaces are there from both sides: light that a back lets through would
// come from nowhere. So the backs are kept, and counted where a camera may see them.
#pragma once

#include <cstdint>
#include <vector>

#include "tracer/scene/gltf_nodes.hpp"
#include "tracer/scene/gltf_primitive.hpp"
#include "tracer/scene/scene.hpp"

namespace raycache::tracer {

/// Triangles of single-sided materials that turn their back to a camera of the scene and lie in its field of view, in
/// placed meshes that are open: the area vectors of a closed surface add up to nothing. What stands before them is not
/// looked for. `scene` holds the placements in order, flattened, and its cameras.
std::uint64_t count_open_back_faces(const Scene& scene, const std::vector<GltfPlacement>&,
                                    const std::vector<std::vector<GltfPrimitive>>& meshes,
                                    const std::vector<bool>& double_sided);

}  // namespace raycache::tracer
