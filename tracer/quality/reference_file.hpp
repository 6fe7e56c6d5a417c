// References on disk: an EXR file of 32-bit floats that says what it shows (its key) and carries a checksum.
#pragma once

#include <string>

#include "tracer/quality/reference.hpp"

namespace raycache::tracer {

/// Channels R, G, B (the mean) and half_difference.R, .G, .B. Throws Error as write_channels() does.
void write_reference(const std::string& path, const Reference&);

/// Throws Error where the file cannot be read, is no whole reference of `size`, fails its checksum, shows anything but
/// `key`, or holds values that no picture has: not finite, negative, or halves that are.
Reference read_reference(const std::string& path, const std::string& key, ImageSize size);

/// Where the reference of that key is kept: "$XDG_CACHE_HOME/raycache/references/HASH.exr", without that variable below
/// "$HOME/.cache"; empty where neither is set.
std::string cached_reference_path(const std::string& key);

}  // namespace raycache::tracer
