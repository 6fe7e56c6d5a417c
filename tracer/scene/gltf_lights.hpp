// The lights of a glTF file that have no size (KHR_lights_punctual).
#pragma once

#include <vector>

#include "tracer/scene/gltf_document.hpp"
#include "tracer/scene/gltf_nodes.hpp"
#include "tracer/scene/scene.hpp"

namespace raycache::tracer {

/// In the order of their placements. Intensities are taken in the unit of emissive materials (candela and lux beside
/// nits). Throws Error for numbers that make no light; a cone or range out of its limits becomes the nearest in them,
/// with one warning.
std::vector<PunctualLight> read_gltf_lights(const GltfDocument&, const std::vector<GltfPlacement>&, const SceneFrame&,
                                            const GltfReport&);

}  // namespace raycache::tracer
