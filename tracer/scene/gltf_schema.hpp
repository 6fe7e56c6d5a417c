// What glTF 2.0 says about the members of its objects: types, numbers of items, ranges, references. tinygltf takes what
// it can of a member of another type; here that is an error which names the place.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "tracer/scene/gltf_report.hpp"

namespace raycache::tracer {

/// Throws Error "PATH: nodes[0].scale: expected 3 numbers, found …" for the first member that is not as the standard
/// (or the extension, of those we read) wants it, among those that have a meaning here. Members of other names are let
/// pass. Integers written as 3.0 become 3, which tinygltf needs.
void check_gltf_schema(nlohmann::json& document, const GltfReport&);

}  // namespace raycache::tracer
