// The GGX distribution of microfacet normals (B. Walter et al., "Microfacet Models for Refraction through Rough
// Surfaces", EGSR 2007; T. Trowbridge, K. Reitz 1975) with Smith's height-correlated masking and shadowing (E. Heitz,
// "Understanding the Masking-Shadowing Function in Microfacet-Based BRDFs", JCGT 3 (2), 2014). Isotropic. All vectors
// unit, z = surface normal.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tracer/vec.hpp"

namespace raycache::tracer {

class Ggx {
public:
    /// Smoother surfaces are perfect mirrors and windows: their lobe (3 arc minutes) is narrower than the sun.
    static constexpr float smooth_below = 0.02F;

    /// glTF: alpha = roughness squared.
    explicit Ggx(float roughness) : alpha_(roughness * roughness) {}

    /// Density of microfacets with normal `h`, per area and solid angle.
    float distribution(Vec3 h) const {
        const float a2 = alpha_ * alpha_;
        // x^2 + y^2 instead of 1 - z^2, which cancels for small alpha.
        const float t = (h.x * h.x + h.y * h.y) / a2 + h.z * h.z;
        return 1 / (std::numbers::pi_v<float> * a2 * t * t);
    }
    /// Share of microfacets that `w` sees.
    float masking(Vec3 w) const { return 1 / (1 + lambda(w)); }
    /// Share that both see; the sides do not matter.
    float masking_shadowing(Vec3 wo, Vec3 wi) const { return 1 / (1 + lambda(wo) + lambda(wi)); }

    /// A microfacet normal as `wo` (z > 0) sees them, with density visible(wo, h): E. Heitz, "Sampling the GGX
    /// Distribution of Visible Normals", JCGT 7 (4), 2018.
    Vec3 sample(Vec3 wo, Vec2 random) const {
        const Vec3 stretched = normalize({alpha_ * wo.x, alpha_ * wo.y, wo.z});
        const float flat = stretched.x * stretched.x + stretched.y * stretched.y;
        const Vec3 across = flat > 0 ? Vec3{-stretched.y, stretched.x, 0} * (1 / std::sqrt(flat)) : Vec3{1, 0, 0};
        const Vec3 up = cross(stretched, across);
        const float radius = std::sqrt(random.x);
        const float phi = 2 * std::numbers::pi_v<float> * random.y;
        const float x = radius * std::cos(phi);
        const float s = 0.5F * (1 + stretched.z);
        const float y = (1 - s) * std::sqrt(std::max(0.0F, 1 - x * x)) + s * radius * std::sin(phi);
        const float z = std::sqrt(std::max(0.0F, 1 - x * x - y * y));
        const Vec3 n = across * x + up * y + stretched * z;
        return normalize({alpha_ * n.x, alpha_ * n.y, std::max(1e-6F, n.z)});
    }
    float visible(Vec3 wo, Vec3 h) const {
        return masking(wo) * distribution(h) * std::max(0.0F, dot(wo, h)) / std::fabs(wo.z);
    }

private:
    float lambda(Vec3 w) const {
        const float z2 = w.z * w.z;
        if (!(z2 > 0)) return 1e18F;
        const float tan2 = (w.x * w.x + w.y * w.y) / z2;
        return 0.5F * (std::sqrt(1 + alpha_ * alpha_ * tan2) - 1);
    }
    float alpha_;
};

/// Mirror image of `w` at a microfacet.
inline Vec3 reflect(Vec3 w, Vec3 h) { return h * (2 * dot(w, h)) - w; }

}  // namespace raycache::tracer
