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

/// The file that a relative URI names, seen from the folder of the glTF file.
struct UriFile {
    std::string path;     ///< empty for a URI with a scheme ("https:", "file:"), an absolute path, a bad escape
    bool exists = false;  ///< there is something at `path`
    std::string note;     ///< how the URI was read where that is not what the standard says
    std::string remedy;   ///< what to do where the file cannot be found; empty: nothing is special about the URI
};

/// Percent-encoding is undone. Where that names no file, those are tried that exporters meant who wrote a % or a
/// backslash as it is.
UriFile find_uri_file(const std::string& gltf_path, std::string_view uri);

}  // namespace raycache::tracer
