#include "tracer/paths/bsdf/bsdf.hpp"

#include "tracer/paths/bsdf/fresnel.hpp"

namespace raycache::tracer {

namespace {

float glass_share(const Material& m, const Shading& s) { return (1 - s.metallic) * m.transmission; }

/// The metallic part of what is not glass.
float metallic_share(const Material& m, const Shading& s) {
    const float opaque = 1 - glass_share(m, s);
    return opaque > 0 ? std::min(1.0F, s.metallic / opaque) : 0;
}

}  // namespace

Bsdf::Bsdf(const Material& m, const Shading& s, bool inside)
    : coverage_(m.alpha_blend ? s.alpha : 1),
      glass_(glass_share(m, s)),
      opaque_part_(s.color, metallic_share(m, s), s.roughness, dielectric_f0(m.ior), s.metallic > 0 || s.roughness < 1),
      glass_part_(s.color, s.roughness, m.ior, m.thin, inside) {}

BsdfValue Bsdf::evaluate(Vec3 wo, Vec3 wi) const {
    BsdfValue f;
    if (glass_ < 1) f += opaque_part_.evaluate(wo, wi) * (1 - glass_);
    if (glass_ > 0) f += glass_part_.evaluate(wo, wi) * glass_;
    return f * coverage_;
}

BsdfSample Bsdf::sample(Vec3 wo, Vec2 random) const {
    if (coverage_ < 1 && !choose(coverage_, random.x)) return {-wo, {1, 1, 1}, 0, true, true};
    const bool glass = glass_ == 1 || (glass_ > 0 && choose(glass_, random.x));
    BsdfSample s = glass ? glass_part_.sample(wo, random) : opaque_part_.sample(wo, random);
    s.pdf *= coverage_;
    if (glass_ == 0 || glass_ == 1 || s.delta || !(max_component(s.weight) > 0)) return s;
    const BsdfValue f = evaluate(wo, s.wi);
    s.weight = f.pdf > 0 ? f.value / f.pdf : Vec3{};
    s.pdf = f.pdf;
    return s;
}

}  // namespace raycache::tracer
