#include "tracer/paths/lights.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "tracer/paths/directions.hpp"

namespace raycache::tracer {

Lights::Lights(const Scene& scene) {
    sun_ = scene.sun.has_value() && max_component(scene.sun->irradiance) > 0;
    if (sun_) {
        sun_light_ = *scene.sun;
        const float half = std::sin(sun_light_.angular_radius / 2), whole = std::sin(sun_light_.angular_radius);
        sun_sine2_ = whole * whole;
        // 1 / solid angle; 2 pi (1 - cos r) = 4 pi sin^2(r / 2).
        sun_pdf_ = 1 / (4 * std::numbers::pi_v<float> * half * half);
    }

    std::vector<double> power;
    for (std::size_t t = 0; t < scene.triangle_count(); ++t) {
        const Material& material = scene.materials[scene.material_of[t]];
        if (!(max_component(material.emission) > 0)) continue;
        const std::uint32_t* index = &scene.indices[3 * t];
        const Vec3 a = scene.positions[index[0]];
        const Vec3 edge1 = scene.positions[index[1]] - a, edge2 = scene.positions[index[2]] - a;
        const Vec3 normal = cross(edge1, edge2);
        const float area = 0.5F * length(normal);
        if (!(area > 0) || !(luminance(material.emission) > 0)) continue;
        emitters_.push_back({a, edge1, edge2, normalize(normal), material.emission, area});
        power.push_back(double{area} * double{luminance(material.emission)});
        power_ += power.back();
    }
    double sum = 0;
    for (const double p : power) {
        sum += p;
        cumulative_.push_back(static_cast<float>(sum / power_));
    }
    if (!cumulative_.empty()) cumulative_.back() = 1;
}

LightSample Lights::sample(Vec3 from, Vec2 random) const {
    if (!sun_) return sample_emitter(from, random);
    if (emitters_.empty()) return sample_sun(random);
    const bool to_sun = random.x < 0.5F;
    random.x = 2 * (to_sun ? random.x : random.x - 0.5F);
    LightSample sample = to_sun ? sample_sun(random) : sample_emitter(from, random);
    sample.radiance_over_pdf = sample.radiance_over_pdf * 2;
    sample.pdf *= 0.5F;
    return sample;
}

float Lights::emitter_pdf(Vec3 emission, float distance, float cosine) const {
    const auto per_area = static_cast<float>(double{luminance(emission)} / power_);
    return (sun_ ? 0.5F : 1.0F) * per_area * distance * distance / std::fabs(cosine);
}

Lights::SunDisc Lights::sun_at(Vec3 direction) const {
    if (!sun_ || !(sun_sine2_ > 0)) return {};
    const Vec3 across = cross(direction, sun_light_.direction);
    if (!(dot(direction, sun_light_.direction) > 0) || dot(across, across) > sun_sine2_) return {};
    return {sun_light_.irradiance * sun_pdf_, emitters_.empty() ? sun_pdf_ : 0.5F * sun_pdf_};
}

LightSample Lights::sample_sun(Vec2 random) const {
    // Uniform over the cone of the disc: radiance / pdf = irradiance, whatever the angle.
    const float cos_max = std::cos(sun_light_.angular_radius);
    const float cos_theta = 1 - random.x * (1 - cos_max);
    const float sin_theta = std::sqrt(std::max(0.0F, 1 - cos_theta * cos_theta));
    const float phi = 2 * std::numbers::pi_v<float> * random.y;
    const Vec3 local{sin_theta * std::cos(phi), sin_theta * std::sin(phi), cos_theta};
    return {to_world(local, sun_light_.direction), std::numeric_limits<float>::infinity(), sun_light_.direction,
            sun_light_.irradiance, sun_pdf_};
}

LightSample Lights::sample_emitter(Vec3 from, Vec2 random) const {
    const auto found = std::upper_bound(cumulative_.begin(), cumulative_.end(), random.x);
    const std::size_t i = std::min(static_cast<std::size_t>(found - cumulative_.begin()), emitters_.size() - 1);
    const float below = i == 0 ? 0 : cumulative_[i - 1];
    const float share = cumulative_[i] - below;
    if (!(share > 0)) return {};
    const float first = std::min((random.x - below) / share, 0x1.fffffep-1F);

    // Uniform point of a triangle: A. Glassner (ed.), Graphics Gems, 1990, p. 24.
    const Emitter& emitter = emitters_[i];
    const float root = std::sqrt(first);
    const Vec3 point = emitter.corner + emitter.edge1 * (root * (1 - random.y)) + emitter.edge2 * (root * random.y);
    const Vec3 way = point - from;
    const float distance = length(way);
    if (!(distance > 0)) return {};
    const Vec3 direction = way / distance;
    const float cosine = std::fabs(dot(emitter.normal, direction));
    const float weight = emitter.area / share * cosine / distance / distance;
    return {direction, distance, emitter.normal, emitter.radiance * weight, 1 / weight};
}

}  // namespace raycache::tracer
