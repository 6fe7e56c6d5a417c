// The BSDF at a vertex of a path, in world space. Purely diffuse vertices do without it: the integrator knows Lambert's
// surface by heart.
#pragma once

#include "tracer/paths/bsdf/bsdf.hpp"
#include "tracer/paths/surface.hpp"

namespace raycache::tracer {

class Scattering {
public:
    /// `arriving`: unit direction of the ray that led here.
    Scattering(const Surface&, const Shading&, Vec3 arriving);

    /// Black where the interpolated normal and the true one disagree about the side of `direction`.
    BsdfValue evaluate(Vec3 direction) const;
    /// `wi` is in world space.
    BsdfSample sample(Vec2 random) const;

private:
    bool sides_agree(Vec3 direction, float local_z) const;
    Vec3 to_local(Vec3 v) const { return {dot(v, tangent_), dot(v, bitangent_), dot(v, normal_)}; }

    Vec3 tangent_, bitangent_, normal_, geometric_normal_;
    Vec3 wo_;  ///< local
    Bsdf bsdf_;
};

/// Whether going on in `direction` counts as transmission (crossing a surface, or staying inside a solid), not as
/// reflection.
inline bool is_transmission(const Surface& s, Vec3 direction) {
    const Material& m = *s.material;
    return dot(direction, s.geometric_normal) < 0 || (s.back && m.transmission > 0 && !m.thin);
}

}  // namespace raycache::tracer
