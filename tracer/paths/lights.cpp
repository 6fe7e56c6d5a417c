#include "tracer/paths/lights.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "tracer/paths/directions.hpp"
#include "tracer/scene/emission.hpp"

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
    add_emitters(scene, power);
    add_punctual(scene, power);
    double sum = 0;
    for (const double p : power) power_ += p;
    for (const double p : power) {
        sum += p;
        cumulative_.push_back(static_cast<float>(sum / power_));
    }
    if (!cumulative_.empty()) cumulative_.back() = 1;
}

void Lights::add_emitters(const Scene& scene, std::vector<double>& power) {
    std::vector<std::uint32_t> triangles;
    std::vector<std::optional<MeanEmission>> of_material(scene.materials.size());
    for (std::size_t t = 0; t < scene.triangle_count(); ++t) {
        const std::uint16_t m = scene.material_of[t];
        const Material& material = scene.materials[m];
        if (!(max_component(material.emission) > 0)) continue;
        if (!of_material[m]) of_material[m].emplace(scene, material);
        if (!of_material[m]->black()) triangles.push_back(static_cast<std::uint32_t>(t));
    }
    std::vector<float> mean(triangles.size());
    tbb::parallel_for(std::size_t{0}, triangles.size(),
                      [&](std::size_t i) { mean[i] = of_material[scene.material_of[triangles[i]]]->of(triangles[i]); });
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        const std::uint32_t t = triangles[i];
        const Material& material = scene.materials[scene.material_of[t]];
        const std::uint32_t* index = &scene.indices[3 * std::size_t{t}];
        const Vec3 a = scene.positions[index[0]];
        const Vec3 edge1 = scene.positions[index[1]] - a, edge2 = scene.positions[index[2]] - a;
        const Vec3d normal = cross(Vec3d(edge1), Vec3d(edge2));  // as in surface.cpp
        const double twice = length(normal);
        const auto area = static_cast<float>(0.5 * twice);
        if (!(area > 0) || !(mean[i] > 0)) continue;
        const auto width = static_cast<float>(std::max(length(Vec3d(edge1)), length(Vec3d(edge2))));
        const bool textured = material.emission_texture >= 0;
        emitters_.push_back({a, edge1, edge2, (normal * (1 / twice)).rounded(), material.emission, area, width, t,
                             textured ? &material : nullptr});
        power.push_back(double{area} * double{mean[i]});
        if (textured) textured_.emplace_back(t, mean[i]);
    }
}

LightSample Lights::sample(Vec3 from, Vec2 random) const {
    if (!sun_) return sample_emitter(from, random);
    if (cumulative_.empty()) return sample_sun(random);
    const bool to_sun = random.x < 0.5F;
    random.x = 2 * (to_sun ? random.x : random.x - 0.5F);
    LightSample sample = to_sun ? sample_sun(random) : sample_emitter(from, random);
    sample.radiance_over_pdf = sample.radiance_over_pdf * 2;
    sample.pdf *= 0.5F;
    return sample;
}

float Lights::emitter_pdf(const Material& material, std::uint32_t triangle, float distance, float cosine) const {
    float mean = luminance(material.emission);
    if (material.emission_texture >= 0) {
        const auto found = std::lower_bound(textured_.begin(), textured_.end(), triangle,
                                            [](const auto& entry, std::uint32_t t) { return entry.first < t; });
        if (found == textured_.end() || found->first != triangle) return 0;
        mean = found->second;
    }
    const auto per_area = static_cast<float>(double{mean} / power_);
    return (sun_ ? 0.5F : 1.0F) * per_area * distance * distance / std::fabs(cosine);
}

Lights::SunDisc Lights::sun_at(Vec3 direction) const {
    if (!sun_ || !(sun_sine2_ > 0)) return {};
    const Vec3 across = cross(direction, sun_light_.direction);
    if (!(dot(direction, sun_light_.direction) > 0) || dot(across, across) > sun_sine2_) return {};
    return {sun_light_.irradiance * sun_pdf_, cumulative_.empty() ? sun_pdf_ : 0.5F * sun_pdf_};
}

LightSample Lights::sample_sun(Vec2 random) const {
    // Uniform over the cone of the disc: radiance / pdf = irradiance, whatever the angle.
    const float cos_max = std::cos(sun_light_.angular_radius);
    const float cos_theta = 1 - random.x * (1 - cos_max);
    const float sin_theta = std::sqrt(std::max(0.0F, 1 - cos_theta * cos_theta));
    const float phi = 2 * std::numbers::pi_v<float> * random.y;
    const Vec3 local{sin_theta * std::cos(phi), sin_theta * std::sin(phi), cos_theta};
    return {to_world(local, sun_light_.direction),
            std::numeric_limits<float>::infinity(),
            sun_light_.direction,
            sun_light_.irradiance,
            sun_pdf_,
            0,
            0};
}

LightSample Lights::sample_emitter(Vec3 from, Vec2 random) const {
    const auto found = std::upper_bound(cumulative_.begin(), cumulative_.end(), random.x);
    const std::size_t i = std::min(static_cast<std::size_t>(found - cumulative_.begin()), cumulative_.size() - 1);
    const float below = i == 0 ? 0 : cumulative_[i - 1];
    const float share = cumulative_[i] - below;
    if (!(share > 0)) return {};
    if (i >= emitters_.size()) return sample_punctual(punctual_[i - emitters_.size()], share, from);
    const float first = std::min((random.x - below) / share, 0x1.fffffep-1F);

    // Uniform point of a triangle: A. Glassner (ed.), Graphics Gems, 1990, p. 24.
    const Emitter& emitter = emitters_[i];
    const float root = std::sqrt(first);
    const float u = root * (1 - random.y), v = root * random.y;
    const Vec3 point = emitter.corner + emitter.edge1 * u + emitter.edge2 * v;
    const Vec3 way = point - from;
    const float distance = length(way);
    if (!(distance > 0)) return {};
    const Vec3 direction = way / distance;
    const float cosine = std::fabs(dot(emitter.normal, direction));
    const float weight = emitter.area / share * cosine / distance / distance;
    const Vec3 n = emitter.normal;
    const float off_origin = std::fabs(n.x * point.x) + std::fabs(n.y * point.y) + std::fabs(n.z * point.z);
    return {direction,
            distance,
            n,
            emitter.radiance * weight,
            1 / weight,
            emitter.width,
            off_origin,
            emitter.textured,
            emitter.triangle,
            u,
            v};
}

}  // namespace raycache::tracer
