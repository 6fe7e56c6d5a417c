// Where a texel lies in the imagined GPU's memory. Assumed (GPU vendors publish no more than "block linear"): RGBA8, no
// mipmaps, textures one after another on 128 B boundaries, each in tiles of 8x4 texels = one 128 B line, made of four
// 4x2-texel sectors of 32 B, so that a line and a sector each cover a compact patch. Lookups are nearest-texel.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "tracer/scene/scene.hpp"

namespace raycache::tracer {

class TexelLayout {
public:
    /// Throws Error if all textures together exceed 2^30 - 2 texels.
    explicit TexelLayout(const Scene&);

    struct Texel {
        std::uint32_t element;  ///< index into the texel region (4 B elements)
        Vec3 color;             ///< linear
        float alpha;
        const std::uint8_t* stored;  ///< the four channels, for textures that are no colours
    };
    Texel fetch(int texture, Vec2 texcoord, TextureLookup lookup = {}) const;

    std::uint32_t count() const { return count_; }  ///< elements of the region; 0 for a scene without textures

private:
    const Scene* scene_;
    std::vector<std::uint32_t> first_;  ///< element of each texture's first tile
    std::uint32_t count_ = 0;
};

/// Texture coordinate at the point (u, v) of a triangle, or (0, 0) where the scene has none.
Vec2 texcoord_at(const Scene&, std::uint32_t triangle, float u, float v, unsigned layer = 0);

/// Colour at the point (u, v) of a triangle of a scene that has colours.
VertexColor vertex_color_at(const Scene&, std::uint32_t triangle, float u, float v);

/// Number of a texel along one axis, from its number in an endless plane of copies of the texture.
std::uint32_t wrap_texel(std::int64_t number, std::uint32_t size, Wrap);

/// What the stored value of a colour channel means (IEC 61966-2-1), 0 to 1.
const std::array<float, 256>& linear_of_srgb();

}  // namespace raycache::tracer
