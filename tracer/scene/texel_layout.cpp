#include "tracer/scene/texel_layout.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "traces/error.hpp"

namespace raycache::tracer {
namespace {

constexpr std::uint32_t tile_width = 8, tile_height = 4, sector_width = 4, sector_height = 2;
constexpr std::uint64_t max_texels = (std::uint64_t{1} << 30) - 2;

std::uint32_t tiles_across(const Texture& t) { return (t.width + tile_width - 1) / tile_width; }
std::uint32_t tiles_down(const Texture& t) { return (t.height + tile_height - 1) / tile_height; }

/// IEC 61966-2-1.
float decode_srgb(float encoded) {
    return encoded <= 0.04045F ? encoded / 12.92F : std::pow((encoded + 0.055F) / 1.055F, 2.4F);
}

const std::array<float, 256>& srgb_table() {
    static const std::array<float, 256> table = [] {
        std::array<float, 256> made{};
        for (std::size_t i = 0; i < 256; ++i) made[i] = decode_srgb(static_cast<float>(i) / 255.0F);
        return made;
    }();
    return table;
}

/// Texel of a coordinate under wrap mode repeat.
std::uint32_t wrap(float coordinate, std::uint32_t size) {
    const float fraction = coordinate - std::floor(coordinate);  // 1 for tiny negative numbers, NaN for non-finite ones
    const float scaled = fraction * static_cast<float>(size);
    return scaled >= 0 && scaled < static_cast<float>(size) ? static_cast<std::uint32_t>(scaled) : 0;
}

}  // namespace

TexelLayout::TexelLayout(const Scene& scene) : scene_(&scene) {
    std::uint64_t next = 0;
    for (const Texture& texture : scene.textures) {
        first_.push_back(static_cast<std::uint32_t>(next));
        next += std::uint64_t{tiles_across(texture)} * tiles_down(texture) * tile_width * tile_height;
        if (next > max_texels)
            throw Error(fmt::format("{}: textures of more than {} texels; make them smaller", scene.name, max_texels));
    }
    count_ = static_cast<std::uint32_t>(next);
}

TexelLayout::Texel TexelLayout::fetch(int index, Vec2 texcoord) const {
    const Texture& texture = scene_->textures[static_cast<std::size_t>(index)];
    const std::uint32_t x = wrap(texcoord.x, texture.width);
    const std::uint32_t y = wrap(texcoord.y, texture.height);
    const std::uint32_t tile = (y / tile_height) * tiles_across(texture) + x / tile_width;
    const std::uint32_t sector =
        (y % tile_height / sector_height) * (tile_width / sector_width) + x % tile_width / sector_width;
    const std::uint32_t in_sector = (y % sector_height) * sector_width + x % sector_width;
    const std::uint8_t* rgba = &texture.rgba[4 * (std::size_t{y} * texture.width + x)];
    const auto& linear = srgb_table();
    return {first_[static_cast<std::size_t>(index)] + tile * tile_width * tile_height +
                sector * sector_width * sector_height + in_sector,
            {linear[rgba[0]], linear[rgba[1]], linear[rgba[2]]},
            static_cast<float>(rgba[3]) / 255.0F,
            rgba};
}

Vec2 texcoord_at(const Scene& scene, std::uint32_t triangle, float u, float v) {
    if (scene.texcoords.empty()) return {};
    const std::uint32_t* index = &scene.indices[3 * std::size_t{triangle}];
    const Vec2 a = scene.texcoords[index[0]], b = scene.texcoords[index[1]], c = scene.texcoords[index[2]];
    const float w = 1 - u - v;
    return {w * a.x + u * b.x + v * c.x, w * a.y + u * b.y + v * c.y};
}

}  // namespace raycache::tracer
