#include "tracer/image_module/webp.hpp"

#include <webp/decode.h>

#include <algorithm>
#include <memory>

namespace raycache::tracer {

std::string webp_layout(std::span<const std::uint8_t> bytes, ImageLayout& layout) {
    WebPBitstreamFeatures features;
    if (WebPGetFeatures(bytes.data(), bytes.size(), &features) != VP8_STATUS_OK) return "its header is not WebP's";
    if (features.has_animation != 0) return "it is a film of several pictures";
    layout.width = features.width;
    layout.height = features.height;
    layout.channels = features.has_alpha != 0 ? 4 : 3;
    layout.channel_names.clear();
    return {};
}

std::string webp_texels(std::span<const std::uint8_t> bytes, int channels, bool floats, void* out, std::size_t stride) {
    if (floats || channels < 1 || channels > 4) return "it has no such channels";
    int width = 0, height = 0;
    const std::unique_ptr<std::uint8_t, void (*)(void*)> rgba(
        WebPDecodeRGBA(bytes.data(), bytes.size(), &width, &height), WebPFree);
    if (!rgba) return "it is cut short or damaged";
    auto* to = static_cast<std::uint8_t*>(out);
    const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    for (std::size_t i = 0; i < pixels; ++i) std::copy_n(rgba.get() + 4 * i, channels, to + i * stride);
    return {};
}

}  // namespace raycache::tracer
