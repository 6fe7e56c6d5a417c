#include "tracer/paths/bsdf/metallic_roughness.hpp"

#include <cmath>
#include <numbers>

#include "tracer/paths/bsdf/fresnel.hpp"
#include "tracer/paths/directions.hpp"

namespace raycache::tracer {

namespace {
constexpr float inv_pi = std::numbers::inv_pi_v<float>;
/// Coats that leave less than this to the body have none: they are perfect mirrors.
constexpr float nothing_left = 1e-4F;
}  // namespace

MetallicRoughness::MetallicRoughness(Vec3 color, float metallic, float roughness, float f0, bool coat)
    : coat_(coat),
      smooth_(roughness < Ggx::smooth_below),
      roughness_(roughness),
      dielectric_f0_(f0),
      ggx_(roughness),
      f0_(Vec3{f0, f0, f0} * (1 - metallic) + color * metallic),
      diffuse_(color * (1 - metallic)) {
    if (!coat) return;
    const GgxAlbedo mean = ggx_mean_albedo(roughness);
    left_ = 1 - mean.of(f0);
    lost_ = 1 - mean.white();
    diffuse_ = left_ > nothing_left ? diffuse_ / left_ : Vec3{};
    if (metallic > 0 && lost_ > nothing_left) {
        const auto share = [&](float c) {
            const float mean_fresnel = c + (1 - c) / 21;
            return metallic * mean_fresnel * mean_fresnel * mean.white() / (1 - mean_fresnel * lost_) / lost_;
        };
        multiple_ = {share(color.x), share(color.y), share(color.z)};
    }
}

Vec3 MetallicRoughness::fresnel(float cosine) const {
    const float rise = schlick_rise(cosine);
    return f0_ * (1 - rise) + Vec3{rise, rise, rise};
}

MetallicRoughness::Leaving MetallicRoughness::leaving(float cosine) const {
    if (!coat_) return {{}, 0};
    const GgxAlbedo albedo = ggx_albedo(cosine, roughness_);
    const float specular = albedo.of(max_component(f0_));
    const float body = max_component(diffuse_) * left_ * (1 - albedo.of(dielectric_f0_)) +
                       max_component(multiple_) * lost_ * (1 - albedo.white());
    return {albedo, body > 0 ? specular / (specular + body) : 1};
}

BsdfValue MetallicRoughness::evaluate(Vec3 wo, Vec3 wi) const { return evaluate(wo, leaving(wo.z), wi); }

BsdfValue MetallicRoughness::evaluate(Vec3 wo, const Leaving& leaving, Vec3 wi) const {
    if (!(wi.z > 0) || !(wo.z > 0)) return {};
    if (!coat_) return {diffuse_ * (inv_pi * wi.z), inv_pi * wi.z};
    const GgxAlbedo out = leaving.albedo, in = ggx_albedo(wi.z, roughness_);
    const float through = (1 - out.of(dielectric_f0_)) * (1 - in.of(dielectric_f0_));
    const float again = (1 - out.white()) * (1 - in.white());
    const float specular = leaving.specular;
    BsdfValue result{(diffuse_ * through + multiple_ * again) * (inv_pi * wi.z), (1 - specular) * inv_pi * wi.z};
    if (!smooth_) {
        const Vec3 h = normalize(wo + wi);
        const float facets = ggx_.distribution(h) / (4 * wo.z);
        result.value += fresnel(dot(wo, h)) * (facets * ggx_.masking_shadowing(wo, wi));
        result.pdf += specular * facets * ggx_.masking(wo);
    }
    return result;
}

BsdfSample MetallicRoughness::sample(Vec3 wo, Vec2 random) const {
    Vec3 wi;
    const Leaving out = leaving(wo.z);
    if (choose(out.specular, random.x)) {
        if (smooth_) return {{-wo.x, -wo.y, wo.z}, fresnel(wo.z) / out.specular, 0, true, false};
        wi = reflect(wo, ggx_.sample(wo, random));
    } else {
        wi = cosine_hemisphere(random);
    }
    const BsdfValue f = evaluate(wo, out, wi);
    return {wi, f.pdf > 0 ? f.value / f.pdf : Vec3{}, f.pdf, false, false};
}

}  // namespace raycache::tracer
