// glTF 2.0's metallic-roughness material (specification 3.9.2 and appendix B): a GGX coat with Schlick's Fresnel term,
// F0 = mix(dielectric F0, base colour, metallic), over a diffuse body of colour (1 - metallic) * base colour.
//
// Appendix B leaves open how coat and body share the light; its sample code, (1 - F(wo.h)) times the body, reflects up
// to twice what arrives near grazing. Here the body gets what the coat leaves on the way in and on the way out,
//   f_body = colour/pi * (1 - E(wo)) (1 - E(wi)) / (1 - mean E),   E: albedo of the coat,
// which is reciprocal and loses nothing (C. Kelemen, L. Szirmay-Kalos, "A Microfacet Based Coupled Specular-Matte BRDF
// Model with Importance Sampling", Eurographics 2001). The same form with E for F = 1 gives back what microfacets of a
// metal scatter more than once (C. Kulla, A. Conty, "Revisiting Physically Based Shading at Imageworks", SIGGRAPH
// course 2017).
#pragma once

#include "tracer/paths/bsdf/bsdf_sample.hpp"
#include "tracer/paths/bsdf/ggx.hpp"
#include "tracer/paths/bsdf/ggx_albedo.hpp"

namespace raycache::tracer {

class MetallicRoughness {
public:
    /// `metallic`, `roughness` in [0, 1]; `f0`: reflectance of the dielectric head on. Without a coat it is Lambert's.
    MetallicRoughness(Vec3 color, float metallic, float roughness, float f0, bool coat);

    BsdfValue evaluate(Vec3 wo, Vec3 wi) const;
    BsdfSample sample(Vec3 wo, Vec2 random) const;

private:
    Vec3 fresnel(float cosine) const;
    /// What depends on wo alone.
    struct Leaving {
        GgxAlbedo albedo;
        float specular;  ///< probability that sample() chooses the coat
    };
    Leaving leaving(float cosine) const;
    BsdfValue evaluate(Vec3 wo, const Leaving&, Vec3 wi) const;

    bool coat_, smooth_;
    float roughness_, dielectric_f0_;
    Ggx ggx_;
    Vec3 f0_;
    Vec3 diffuse_;               ///< colour of the dielectric's body, over `left_`
    Vec3 multiple_;              ///< colour of the metal's multiple scattering, over `lost_`
    float left_ = 1, lost_ = 0;  ///< 1 - mean E, of the dielectric's coat and of a white one
};

}  // namespace raycache::tracer
