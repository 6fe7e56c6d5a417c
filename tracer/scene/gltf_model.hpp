// tinygltf, configured: it turns the JSON text into structures and never opens a file or decodes an image itself.
#pragma once

#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_EXTERNAL_IMAGE
#define TINYGLTF_NO_FS
#define TINYGLTF_NO_INCLUDE_JSON
#include <tiny_gltf.h>

#include <string>

namespace raycache::tracer {

/// Parses `json_text`. tinygltf checks little: no index, count, offset or length in the result may be trusted.
/// On failure the model is incomplete and `problems` says why (in tinygltf's words, possibly several lines).
tinygltf::Model parse_gltf_model(const std::string& json_text, std::string& problems);

}  // namespace raycache::tracer
