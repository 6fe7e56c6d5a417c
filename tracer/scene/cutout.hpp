// Alpha-masked materials (glTF alphaMode MASK): is the point of a triangle there, or a hole?
#pragma once

#include <cstdint>

#include "tracer/scene/scene.hpp"
#include "tracer/scene/texel_layout.hpp"

namespace raycache::tracer {

struct Cutout {
    bool solid;             ///< alpha reaches the material's cutoff
    bool textured;          ///< a texel decided
    std::uint32_t element;  ///< that texel's
};

/// At (u, v) of a triangle whose material may have holes.
inline Cutout cutout_at(const Scene& scene, const TexelLayout& texels, std::uint32_t triangle, float u, float v) {
    const Material& material = scene.materials[scene.material_of[triangle]];
    const float alpha =
        material.vertex_alpha ? material.alpha * vertex_color_at(scene, triangle, u, v).alpha : material.alpha;
    if (material.base_color_texture < 0) return {alpha >= material.alpha_cutoff, false, 0};
    const TextureLookup lookup = material.base_color_lookup;
    const auto texel =
        texels.fetch(material.base_color_texture, texcoord_at(scene, triangle, u, v, lookup.layer), lookup);
    return {alpha * texel.alpha >= material.alpha_cutoff, true, texel.element};
}

}  // namespace raycache::tracer
