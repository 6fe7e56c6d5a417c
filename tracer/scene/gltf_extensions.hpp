// Which extensions of glTF are read, which only change how things look and can be left out, and which hold geometry.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "tracer/scene/gltf_report.hpp"

namespace raycache::tracer {

/// One warning names each extension of `extensionsUsed` that is left out, with what the picture lacks for it, where
/// that is known. Throws Error for a required one that we lack, unless it concerns look or light alone.
void check_gltf_extensions(const nlohmann::json& document, const GltfReport&);

}  // namespace raycache::tracer
