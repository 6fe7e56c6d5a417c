// Where the coordinates of a glTF file are centred before they become floats, and what float loses all the same.
#pragma once

#include <vector>

#include "tracer/scene/gltf_document.hpp"
#include "tracer/scene/gltf_nodes.hpp"
#include "tracer/scene/gltf_primitive.hpp"
#include "tracer/scene/scene_frame.hpp"

namespace raycache::tracer {

/// Meshes of a file as they stand in the world: placements, and for each mesh its primitives.
struct GltfPlacedMeshes {
    const std::vector<GltfPlacement>& placements;
    const std::vector<std::vector<GltfPrimitive>>& primitives;
};

/// The frame of a scene, and how large what it is centred on is.
struct GltfFrame {
    SceneFrame frame;
    double detail = 0;  ///< metres: how near to the centre an eighth of the triangles comes, or the camera stands
};

/// Centred on the surface nearest to the file's first perspective camera, or without one on the median of the
/// triangles: where the file is not far from the origin for its size, that stays the origin, so that such files keep
/// their coordinates. Sizes that float products cannot carry (details below a micrometre or above a million
/// kilometres) get another unit. Depends on the file alone, not on the camera chosen.
GltfFrame choose_gltf_frame(const GltfPlacedMeshes&, const std::vector<GltfPlacement>& cameras, const GltfDocument&);

/// Warns, in at most a line of each kind, about meshes whose vertices or places float cannot resolve.
void report_coarse_places(const GltfPlacedMeshes&, const GltfFrame&, const GltfReport&);

/// `to_world`, ending in the coordinates of the frame.
Transform in_frame(const Transform& to_world, const SceneFrame&);

}  // namespace raycache::tracer
