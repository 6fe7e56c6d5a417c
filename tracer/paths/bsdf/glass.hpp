// Transmission of glTF: KHR_materials_transmission for thin panes (light goes through without bending; roughness
// spreads it as a mirror image of the reflection), with KHR_materials_volume for solids (light bends at each surface:
// B. Walter et al., "Microfacet Models for Refraction through Rough Surfaces", EGSR 2007). Index from
// KHR_materials_ior. Base colour tints what goes through, once per surface. Fresnel's equations instead of Schlick's
// term: they know total reflection.
//
// Inside a solid radiance is the square of the index times that outside (E. Veach, PhD thesis 1997, section 5.2); what
// goes in and out again is unchanged. Rough glass scatters once per surface: what microfacets would scatter again is
// lost.
#pragma once

#include "tracer/paths/bsdf/bsdf_sample.hpp"
#include "tracer/paths/bsdf/ggx.hpp"

namespace raycache::tracer {

class Glass {
public:
    /// `inside`: the ray is within the solid. `ior`: at least 1, or 0 for a perfect reflector.
    Glass(Vec3 color, float roughness, float ior, bool thin, bool inside);

    BsdfValue evaluate(Vec3 wo, Vec3 wi) const;
    BsdfSample sample(Vec3 wo, Vec2 random) const;

private:
    float fresnel(float cosine, float& cosine_far) const;
    float reflection_probability(float cosine) const;
    BsdfValue through_solid(Vec3 wo, Vec3 wi) const;

    Vec3 color_;
    bool thin_, smooth_, mirror_;
    float eta_;  ///< index of the far side over that of the near one
    Ggx ggx_;
};

}  // namespace raycache::tracer
