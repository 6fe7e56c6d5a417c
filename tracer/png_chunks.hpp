// Is a PNG file whole? Asked before decoding, because libpng reports damage on stderr and OpenImageIO leaks on it.
#pragma once

#include <cstdint>
#include <span>

namespace raycache::tracer {

/// Whether `bytes` are the PNG signature and a list of chunks from IHDR to IEND, each complete and with its checksum.
/// What the chunks hold is not looked at.
bool is_whole_png(std::span<const std::uint8_t> bytes);

}  // namespace raycache::tracer
