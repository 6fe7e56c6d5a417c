// The JSON text of a glTF file, parsed, found to be glTF 2.0, and brought into the form that tinygltf reads.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string_view>

#include "tracer/scene/gltf_report.hpp"

namespace raycache::tracer {

/// Without extras. Throws Error: no JSON, no object, too deep, more than the report's budget.
nlohmann::json parse_gltf_json(std::string_view text, const GltfReport&);

/// Throws Error unless asset.version is 2.x and asset.minVersion, if any, at most 2.0 (glTF 2.0 specification, 3.2).
void check_gltf_version(const nlohmann::json& document, const GltfReport&);

/// Says in terms of core glTF what extensions say otherwise, in a document that has passed check_gltf_schema():
/// materials of specular and glossiness without a metallic-roughness form get one; WebP images become the textures'.
void rewrite_gltf_extensions(nlohmann::json& document);

}  // namespace raycache::tracer
