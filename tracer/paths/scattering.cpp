#include "tracer/paths/scattering.hpp"

#include <algorithm>

#include "tracer/paths/directions.hpp"

namespace raycache::tracer {

namespace {

/// Interpolated normals may turn away from the ray; then the true one is used.
Vec3 facing_normal(const Surface& s, Vec3 wo) {
    constexpr float least_cosine = 1e-3F;
    return dot(s.shading_normal, wo) > least_cosine ? s.shading_normal : s.geometric_normal;
}

}  // namespace

Scattering::Scattering(const Surface& surface, const Shading& shading, Vec3 arriving)
    : normal_(facing_normal(surface, -arriving)),
      geometric_normal_(surface.geometric_normal),
      bsdf_(*surface.material, shading, surface.back) {
    tangent_ = to_world({1, 0, 0}, normal_);
    bitangent_ = to_world({0, 1, 0}, normal_);
    wo_ = to_local(-arriving);
    wo_.z = std::max(wo_.z, 1e-6F);
}

bool Scattering::sides_agree(Vec3 direction, float local_z) const {
    return dot(direction, geometric_normal_) * local_z > 0;
}

BsdfValue Scattering::evaluate(Vec3 direction) const {
    const Vec3 wi = to_local(direction);
    return sides_agree(direction, wi.z) ? bsdf_.evaluate(wo_, wi) : BsdfValue{};
}

BsdfSample Scattering::sample(Vec2 random) const {
    BsdfSample s = bsdf_.sample(wo_, random);
    const float z = s.wi.z;
    s.wi = normalize(tangent_ * s.wi.x + bitangent_ * s.wi.y + normal_ * z);
    if (!s.straight && !sides_agree(s.wi, z)) s.weight = {};
    return s;
}

}  // namespace raycache::tracer
