#include "tracer/scene/texel_layout.hpp"

#include <fmt/format.h>

#include <algorithm>
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

/// Texel of a coordinate.
std::uint32_t texel_at(float coordinate, std::uint32_t size, Wrap wrap) {
    const float period = std::floor(coordinate);
    float fraction = coordinate - period;  // 1 for tiny negative numbers, NaN for non-finite ones
    if (wrap == Wrap::clamp) {
        if (!(coordinate > 0)) return 0;
        if (coordinate >= 1) return size - 1;
    } else if (wrap == Wrap::mirror && std::fmod(period, 2.0F) != 0) {
        fraction = 1 - fraction;
        if (fraction >= 1) return size - 1;
    }
    const float scaled = fraction * static_cast<float>(size);
    return scaled >= 0 && scaled < static_cast<float>(size) ? static_cast<std::uint32_t>(scaled) : 0;
}

}  // namespace

const std::array<float, 256>& linear_of_srgb() {
    static const std::array<float, 256> table = [] {
        std::array<float, 256> made{};
        for (std::size_t i = 0; i < 256; ++i) made[i] = decode_srgb(static_cast<float>(i) / 255.0F);
        return made;
    }();
    return table;
}

std::uint32_t wrap_texel(std::int64_t number, std::uint32_t size, Wrap wrap) {
    const auto width = static_cast<std::int64_t>(size);
    if (wrap == Wrap::clamp) return static_cast<std::uint32_t>(std::clamp<std::int64_t>(number, 0, width - 1));
    const std::int64_t period = wrap == Wrap::mirror ? 2 * width : width;
    const std::int64_t within = (number % period + period) % period;
    return static_cast<std::uint32_t>(within < width ? within : period - 1 - within);
}

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

TexelLayout::Texel TexelLayout::fetch(int index, Vec2 texcoord, TextureLookup lookup) const {
    const Texture& texture = scene_->textures[static_cast<std::size_t>(index)];
    const std::uint32_t x = texel_at(texcoord.x, texture.width, lookup.s);
    const std::uint32_t y = texel_at(texcoord.y, texture.height, lookup.t);
    const std::uint32_t tile = (y / tile_height) * tiles_across(texture) + x / tile_width;
    const std::uint32_t sector =
        (y % tile_height / sector_height) * (tile_width / sector_width) + x % tile_width / sector_width;
    const std::uint32_t in_sector = (y % sector_height) * sector_width + x % sector_width;
    const std::uint8_t* rgba = &texture.rgba[4 * (std::size_t{y} * texture.width + x)];
    const auto& linear = linear_of_srgb();
    return {first_[static_cast<std::size_t>(index)] + tile * tile_width * tile_height +
                sector * sector_width * sector_height + in_sector,
            {linear[rgba[0]], linear[rgba[1]], linear[rgba[2]]},
            static_cast<float>(rgba[3]) / 255.0F,
            rgba};
}

Vec2 texcoord_at(const Scene& scene, std::uint32_t triangle, float u, float v, unsigned layer) {
    const std::vector<Vec2>& texcoords = layer == 0 ? scene.texcoords : scene.more_texcoords[layer - 1];
    if (texcoords.empty()) return {};
    const std::uint32_t* index = &scene.indices[3 * std::size_t{triangle}];
    const Vec2 a = texcoords[index[0]], b = texcoords[index[1]], c = texcoords[index[2]];
    const float w = 1 - u - v;
    return {w * a.x + u * b.x + v * c.x, w * a.y + u * b.y + v * c.y};
}

VertexColor vertex_color_at(const Scene& scene, std::uint32_t triangle, float u, float v) {
    const std::uint32_t* index = &scene.indices[3 * std::size_t{triangle}];
    const VertexColor &a = scene.colors[index[0]], &b = scene.colors[index[1]], &c = scene.colors[index[2]];
    const float w = 1 - u - v;
    return {a.color * w + b.color * u + c.color * v, w * a.alpha + u * b.alpha + v * c.alpha};
}

}  // namespace raycache::tracer
