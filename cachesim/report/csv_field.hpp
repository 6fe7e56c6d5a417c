// A field of comma-separated values (RFC 4180).
#pragma once

#include <string>

#include "traces/printable.hpp"

namespace raycache::cachesim {

/// The text on one line and without control characters, in quotes where it has to be.
inline std::string csv_field(const std::string& name) {
    const std::string text = printable_line(name);
    if (text.find_first_of(",\"") == std::string::npos) return text;
    std::string quoted = "\"";
    for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
    return quoted + '"';
}

}  // namespace raycache::cachesim
