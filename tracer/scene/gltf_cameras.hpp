// The cameras of a scene: those of a glTF file, or one that sees everything.
#pragma once

#include <vector>

#include "tracer/scene/gltf_document.hpp"
#include "tracer/scene/gltf_nodes.hpp"
#include "tracer/scene/scene.hpp"

namespace raycache::tracer {

/// Perspective cameras in the order of their nodes, named after the node, else the camera, else "camera<index>".
/// Orthographic ones, and those whose field of view or transform makes no picture, are skipped with one warning.
std::vector<Camera> read_gltf_cameras(const GltfDocument&, const std::vector<GltfPlacement>&, const SceneFrame&,
                                      const GltfReport&);

/// What a camera for a file without one should have in view: all triangles or, where a tenth of them at most lies more
/// than 20 times as far away as the others reach, those others, with a warning.
Box box_in_view(const Scene&, const GltfReport&);

/// A camera named "auto" that has the whole box in view in any picture that is no higher than wide.
Camera overview_camera(const Box&, const SceneFrame& = {});

/// What is wrong with an eye there, in words; empty where nothing is.
std::string problem_of_eye(Vec3d world, const SceneFrame&);

/// The unit vector nearest to `up` that is orthogonal to the unit vector `forward`; any such where they are parallel.
Vec3 orthogonal_up(Vec3 forward, Vec3 up);

}  // namespace raycache::tracer
