// A field of comma-separated values (RFC 4180).
#pragma once

#include <string>

namespace raycache::cachesim {

/// The text, in quotes where it has to be.
inline std::string csv_field(const std::string& text) {
    if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
    std::string quoted = "\"";
    for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
    return quoted + '"';
}

}  // namespace raycache::cachesim
