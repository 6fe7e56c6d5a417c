// The BSDF of a glTF material at one point: a mixture of the metallic-roughness surface and of glass, behind an alpha
// that lets rays pass straight.
#pragma once

#include "tracer/paths/bsdf/bsdf_sample.hpp"
#include "tracer/paths/bsdf/glass.hpp"
#include "tracer/paths/bsdf/metallic_roughness.hpp"
#include "tracer/scene/scene.hpp"

namespace raycache::tracer {

/// What textures and factors of a material come to at a point. All in [0, 1].
struct Shading {
    Vec3 color;
    float alpha = 1, metallic = 0, roughness = 1;
};

class Bsdf {
public:
    /// `inside`: the ray arrives at the back of the surface.
    Bsdf(const Material&, const Shading&, bool inside);

    BsdfValue evaluate(Vec3 wo, Vec3 wi) const;
    /// By two numbers in [0, 1); the first also chooses among lobes.
    BsdfSample sample(Vec3 wo, Vec2 random) const;

private:
    float coverage_;  ///< probability that the surface is there
    float glass_;     ///< share of the mixture
    MetallicRoughness opaque_part_;
    Glass glass_part_;
};

}  // namespace raycache::tracer
