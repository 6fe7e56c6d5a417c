// The URIs of a glTF file: "data:" with base64, or a path relative to the file.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace raycache::tracer {

bool is_data_uri(std::string_view uri);

/// The bytes of a "data:[media type];base64,…" URI; nothing if it is not base64 or malformed.
std::optional<std::vector<std::uint8_t>> decode_data_uri(std::string_view uri);

/// Path of the file that a relative URI names, seen from the folder of `gltf_path`; percent-encoding is undone.
/// Nothing for a URI with a scheme ("https:", "file:"), an absolute path, a NUL, or a malformed percent sign.
std::optional<std::string> resolve_relative_uri(const std::string& gltf_path, std::string_view uri);

}  // namespace raycache::tracer
