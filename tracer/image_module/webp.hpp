// WebP images by libwebp. OpenImageIO reads them too, but multiplies colours by alpha, which cannot be undone in 8
// bits.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "tracer/image_codec.hpp"

namespace raycache::tracer {

/// As ImageCodec::read_layout() and read_texels(), of 3 channels or 4.
std::string webp_layout(std::span<const std::uint8_t> bytes, ImageLayout& layout);
std::string webp_texels(std::span<const std::uint8_t> bytes, int channels, bool floats, void* out, std::size_t stride);

}  // namespace raycache::tracer
