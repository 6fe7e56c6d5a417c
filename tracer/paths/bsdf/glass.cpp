#include "tracer/paths/bsdf/glass.hpp"

#include <algorithm>
#include <cmath>

#include "tracer/paths/bsdf/fresnel.hpp"

namespace raycache::tracer {

namespace {
/// Indices nearer to 1 bend rough glass's rays less than its lobes can tell, and leave its formulas without digits.
constexpr float no_bend = 0.005F;
}  // namespace

Glass::Glass(Vec3 color, float roughness, float ior, bool thin, bool inside)
    : color_(color),
      thin_(thin),
      smooth_(roughness < Ggx::smooth_below || (!thin && std::fabs(ior - 1) < no_bend)),
      mirror_(ior == 0),
      eta_(mirror_           ? 1
           : inside && !thin ? 1 / ior
                             : ior),
      ggx_(roughness) {}

float Glass::fresnel(float cosine, float& cosine_far) const {
    if (!mirror_) return dielectric_fresnel(std::min(cosine, 1.0F), eta_, cosine_far);
    cosine_far = 0;
    return 1;
}

/// Facets turned otherwise than the surface may reflect more or less than it: neither side is left out.
float Glass::reflection_probability(float cosine) const {
    float far = 0;
    const float f = fresnel(cosine, far);
    return mirror_ || eta_ == 1 ? f : std::clamp(f, 0.1F, 0.9F);
}

BsdfValue Glass::evaluate(Vec3 wo, Vec3 wi) const {
    if (smooth_ || !(wo.z > 0)) return {};
    if (wi.z < 0 && !thin_) return through_solid(wo, wi);
    const Vec3 mirrored{wi.x, wi.y, std::fabs(wi.z)};
    if (!(mirrored.z > 0)) return {};
    const Vec3 h = normalize(wo + mirrored);
    float far = 0;
    const float f = fresnel(dot(wo, h), far), reflected = reflection_probability(wo.z);
    const float facets = ggx_.distribution(h) / (4 * wo.z);
    const float value = facets * ggx_.masking_shadowing(wo, mirrored), pdf = facets * ggx_.masking(wo);
    if (wi.z > 0) return {Vec3{f, f, f} * value, pdf * reflected};
    return {color_ * ((1 - f) * value), pdf * (1 - reflected)};
}

BsdfValue Glass::through_solid(Vec3 wo, Vec3 wi) const {
    Vec3 h = normalize(wo + wi * eta_);
    if (h.z < 0) h = -h;
    const float oh = dot(wo, h), ih = dot(wi, h);
    if (!(oh > 0) || !(ih < 0)) return {};
    float far = 0;
    const float f = fresnel(oh, far);
    const float denominator = oh + eta_ * ih;
    const float common = ggx_.distribution(h) * oh * -ih / (wo.z * denominator * denominator);
    return {color_ * (common * (1 - f) * ggx_.masking_shadowing(wo, wi)),
            common * eta_ * eta_ * ggx_.masking(wo) * (1 - reflection_probability(wo.z))};
}

BsdfSample Glass::sample(Vec3 wo, Vec2 random) const {
    float far = 0;
    if (smooth_) {
        if (choose(fresnel(wo.z, far), random.x)) return {{-wo.x, -wo.y, wo.z}, {1, 1, 1}, 0, true, false};
        if (thin_) return {-wo, color_, 0, true, false};
        return {{-wo.x / eta_, -wo.y / eta_, -far}, color_ / (eta_ * eta_), 0, true, false};
    }
    const bool reflected = choose(reflection_probability(wo.z), random.x);
    const Vec3 h = ggx_.sample(wo, random);
    Vec3 wi = reflect(wo, h);
    if (!reflected && thin_) {
        wi.z = -wi.z;
    } else if (!reflected) {
        const float oh = dot(wo, h);
        if (fresnel(oh, far) >= 1) return {};
        wi = normalize(h * (oh / eta_ - far) - wo / eta_);
    }
    if (!(reflected ? wi.z > 0 : wi.z < 0)) return {};
    const BsdfValue f = evaluate(wo, wi);
    return {wi, f.pdf > 0 ? f.value / f.pdf : Vec3{}, f.pdf, false, false};
}

}  // namespace raycache::tracer
