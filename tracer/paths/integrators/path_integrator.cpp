#include "tracer/paths/integrators/path_integrator.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>

#include "tracer/paths/directions.hpp"
#include "tracer/paths/scattering.hpp"
#include "tracer/paths/surface.hpp"

namespace raycache::tracer {
namespace {

constexpr unsigned lanes = PathLanes::count;
constexpr float infinity = std::numeric_limits<float>::infinity();

template <class Body>
void for_each(std::uint32_t mask, Body body) {
    for (; mask != 0; mask &= mask - 1) body(static_cast<unsigned>(std::countr_zero(mask)));
}

/// Ends before the light's plane, to which the ray's start may have moved nearer, or beyond it: short of it by what the
/// test of the light's triangle may be wrong along the ray, as in surface.hpp, but no more than a 10 000th of the way,
/// and by the rounding of its corners.
Ray shadow_ray(const Surface& s, const LightSample& light) {
    if (light.distance == infinity) return {s.leave(light.direction), light.direction, 0, infinity};
    constexpr float rounding = 0x1p-24F, test_error = 32, most = 1e-4F;
    const Vec3 origin = s.leave(light.direction);
    const float cosine = std::fabs(dot(light.direction, light.normal));
    const float nearer = dot(origin - s.position, light.normal) / dot(light.direction, light.normal);
    const float way = light.distance - nearer;
    const float margin = std::min(most * way, test_error * rounding * (way + light.width) / cosine) +
                         4 * rounding * light.off_origin / cosine;
    return {origin, light.direction, 0, std::max(0.0F, way - margin)};
}

/// Share of the technique that has density `mine` where another has `other`, exponent 2 (Veach & Guibas 1995).
float power_heuristic(float mine, float other) {
    if (mine == infinity) return 1;
    const float ratio = other / mine;
    return 1 / (1 + ratio * ratio);
}

traces::RayType type_of(std::uint32_t vertex) {
    return vertex == 0 ? traces::RayType::camera : traces::RayType::bounce;
}

}  // namespace

void PathIntegrator::trace(std::uint32_t mask, const std::array<PathLane, lanes>& jobs,
                           std::array<Vec3, lanes>& radiance) {
    PathLanes& p = lanes_;
    for_each(mask, [&](unsigned l) { p.job[l] = jobs[l]; });
    generate(mask, p);
    traversal_.closest(mask, traces::RayType::camera, 0, p.rays, p.hits);
    std::uint32_t alive = arrive(mask, 0, p);
    for (std::uint32_t vertex = 0; alive != 0; ++vertex) {
        const auto bounce = static_cast<std::uint8_t>(vertex);
        alive = shade(alive, vertex, p);
        if (const std::uint32_t shadow = aim_at_light(alive, vertex, p); shadow != 0)
            collect_light(shadow & ~traversal_.occluded(shadow, traces::RayType::shadow, bounce, p.shadow_rays), p);
        alive = scatter(alive, vertex, p);
        if (alive == 0) break;
        traversal_.closest(alive, traces::RayType::bounce, static_cast<std::uint8_t>(vertex + 1), p.rays, p.hits);
        alive = arrive(alive, vertex + 1, p);
    }
    for_each(mask, [&](unsigned l) { radiance[l] = p.radiance[l]; });
}

void PathIntegrator::generate(std::uint32_t mask, PathLanes& p) const {
    for_each(mask, [&](unsigned l) {
        p.rays[l] = camera_.ray(p.job[l].x, p.job[l].y, pair(p.job[l], 0));
        p.throughput[l] = {1, 1, 1};
        p.radiance[l] = {};
        p.scatter_pdf[l] = infinity;
        p.reflections[l] = p.transmissions[l] = 0;
    });
}

std::uint32_t PathIntegrator::arrive(std::uint32_t mask, std::uint32_t vertex, PathLanes& p) {
    std::uint32_t hit = 0, glowing = 0;
    std::uint32_t glow_element[lanes];
    for_each(mask, [&](unsigned l) {
        const bool for_lights_alone = vertex > settings_.bounces || p.reflections[l] > settings_.bounces_diffuse ||
                                      p.transmissions[l] > settings_.bounces_transmission;
        const float pdf = p.scatter_pdf[l];
        if (!p.hits[l].found()) {
            if (!for_lights_alone) p.radiance[l] += p.throughput[l] * scene_.sky;
            if (vertex > 0 && pdf > 0) {  // the camera does not see the sun's disc
                const auto sun = lights_.sun_at(p.rays[l].direction);
                p.radiance[l] += p.throughput[l] * sun.radiance * power_heuristic(pdf, sun.pdf);
            }
            return;
        }
        p.surface[l] = surface_at(scene_, p.rays[l], p.hits[l]);
        const Material& material = *p.surface[l].material;
        if (Vec3 emission = material.emission; pdf > 0 && max_component(emission) > 0) {
            const Hit& at = p.hits[l];
            if (material.emission_texture >= 0) {
                const auto texel = emission_texel(material, at.triangle, at.u, at.v);
                glow_element[l] = texel.element;
                emission *= texel.color;
                glowing |= 1U << l;
            }
            const float cosine = dot(p.surface[l].geometric_normal, p.rays[l].direction);
            p.radiance[l] += p.throughput[l] * emission *
                             power_heuristic(pdf, lights_.emitter_pdf(material, at.triangle, at.t, cosine));
        }
        if (!for_lights_alone) hit |= 1U << l;
    });
    if (glowing != 0) traversal_.read_texels(glowing, type_of(vertex), static_cast<std::uint8_t>(vertex), glow_element);
    return hit;
}

std::uint32_t PathIntegrator::shade(std::uint32_t mask, std::uint32_t vertex, PathLanes& p) {
    std::uint32_t colored = 0, roughened = 0, alive = 0;
    std::uint32_t color_element[lanes], roughness_element[lanes];
    for_each(mask, [&](unsigned l) {
        const Material& material = *p.surface[l].material;
        Shading shading{material.base_color, material.alpha, material.metallic, material.roughness};
        const Hit& hit = p.hits[l];
        if (material.base_color_texture >= 0) {
            const TextureLookup lookup = material.base_color_lookup;
            const auto texel = texels_.fetch(material.base_color_texture,
                                             texcoord_at(scene_, hit.triangle, hit.u, hit.v, lookup.layer), lookup);
            color_element[l] = texel.element;
            shading.color *= texel.color;
            shading.alpha *= texel.alpha;
            colored |= 1U << l;
        }
        if (!scene_.colors.empty()) {
            const VertexColor vertex_color = vertex_color_at(scene_, hit.triangle, hit.u, hit.v);
            shading.color *= vertex_color.color;
            shading.alpha *= vertex_color.alpha;
        }
        if (material.diffuse()) {
            p.throughput[l] *= shading.color;
        } else {
            if (material.metallic_roughness_texture >= 0) {
                const TextureLookup lookup = material.metallic_roughness_lookup;
                const auto texel = texels_.fetch(material.metallic_roughness_texture,
                                                 texcoord_at(scene_, hit.triangle, hit.u, hit.v, lookup.layer), lookup);
                roughness_element[l] = texel.element;
                shading.roughness *= static_cast<float>(texel.stored[1]) / 255;
                shading.metallic *= static_cast<float>(texel.stored[2]) / 255;
                roughened |= 1U << l;
            }
            p.shading[l] = shading;
        }
        if (max_component(p.throughput[l]) > 0) alive |= 1U << l;
    });
    const auto bounce = static_cast<std::uint8_t>(vertex);
    if (colored != 0) traversal_.read_texels(colored, type_of(vertex), bounce, color_element);
    if (roughened != 0) traversal_.read_texels(roughened, type_of(vertex), bounce, roughness_element);
    return alive;
}

std::uint32_t PathIntegrator::aim_at_light(std::uint32_t mask, std::uint32_t vertex, PathLanes& p) {
    if (lights_.empty() || settings_.lights == LightSampling::bsdf) return 0;
    std::uint32_t shadow = 0, glowing = 0;
    std::uint32_t glow_element[lanes];
    for_each(mask, [&](unsigned l) {
        const Surface& s = p.surface[l];
        const LightSample light = lights_.sample(s.position, pair(p.job[l], 2 + 4 * vertex));
        const bool diffuse = s.material->diffuse();
        BsdfValue f;
        if (diffuse) {
            const float cosine = dot(s.shading_normal, light.direction);
            if (!(cosine > 0) || !(dot(s.geometric_normal, light.direction) > 0)) return;
            f.pdf = cosine * std::numbers::inv_pi_v<float>;
            f.value = {f.pdf, f.pdf, f.pdf};
        } else {
            f = Scattering(s, p.shading[l], p.rays[l].direction).evaluate(light.direction);
        }
        p.contribution[l] = p.throughput[l] * light.radiance_over_pdf * f.value;
        if (!(max_component(p.contribution[l]) > 0)) return;
        if (light.textured) {
            const auto texel = emission_texel(*light.textured, light.triangle, light.u, light.v);
            glow_element[l] = texel.element;
            glowing |= 1U << l;
            p.contribution[l] *= texel.color;
            if (!(max_component(p.contribution[l]) > 0)) return;
        }
        // No bounce ray will find the light where the path ends.
        if (weighs_both(diffuse) && may_go_on(p, l, vertex, is_transmission(s, light.direction)))
            p.contribution[l] = p.contribution[l] * power_heuristic(light.pdf, f.pdf);
        p.shadow_rays[l] = shadow_ray(s, light);
        shadow |= 1U << l;
    });
    if (glowing != 0) traversal_.read_texels(glowing, type_of(vertex), static_cast<std::uint8_t>(vertex), glow_element);
    return shadow;
}

TexelLayout::Texel PathIntegrator::emission_texel(const Material& material, std::uint32_t triangle, float u,
                                                  float v) const {
    const TextureLookup lookup = material.emission_lookup;
    return texels_.fetch(material.emission_texture, texcoord_at(scene_, triangle, u, v, lookup.layer), lookup);
}

void PathIntegrator::collect_light(std::uint32_t unblocked, PathLanes& p) const {
    for_each(unblocked, [&](unsigned l) { p.radiance[l] += p.contribution[l]; });
}

std::uint32_t PathIntegrator::scatter(std::uint32_t mask, std::uint32_t vertex, PathLanes& p) const {
    const bool bsdf_alone = settings_.lights == LightSampling::bsdf && !lights_.empty();
    if (vertex == settings_.bounces && !bsdf_alone) return 0;
    std::uint32_t alive = 0;
    for_each(mask, [&](unsigned l) {
        const Surface& s = p.surface[l];
        const bool diffuse = s.material->diffuse();
        const Vec2 random = pair(p.job[l], 4 + 4 * vertex);
        Vec3 direction;
        bool delta = false;
        float pdf = 0;
        if (diffuse) {
            // Cosine-distributed: reflectance, already in the throughput, is the whole weight.
            direction = to_world(cosine_hemisphere(random), s.shading_normal);
            if (!(dot(direction, s.geometric_normal) > 0)) return;
            pdf = dot(direction, s.shading_normal) * std::numbers::inv_pi_v<float>;
        } else {
            const Scattering scattering(s, p.shading[l], p.rays[l].direction);
            const BsdfSample sample = scattering.sample(random);
            if (!(max_component(sample.weight) > 0)) return;
            direction = sample.wi;
            delta = sample.delta;
            if (!delta && weighs_both(diffuse)) pdf = sample.pdf;
            p.throughput[l] *= sample.weight;
        }
        const bool transmission = is_transmission(s, direction);
        // The last ray of `bsdf` looks for the light that a shadow ray would have found in the other modes.
        if (!may_go_on(p, l, vertex, transmission) && (!bsdf_alone || delta)) return;
        if (settings_.russian_roulette && vertex >= 2) {
            const float survival = std::min(0.95F, max_component(p.throughput[l]));
            if (number(p.job[l], 2 + 4 * (settings_.bounces + 1) + vertex) >= survival) return;
            p.throughput[l] = p.throughput[l] / survival;
        }
        ++(transmission ? p.transmissions : p.reflections)[l];
        p.scatter_pdf[l] = delta || bsdf_alone ? infinity : weighs_both(diffuse) ? pdf : 0;
        p.rays[l] = {s.leave(direction), direction, 0, infinity};
        alive |= 1U << l;
    });
    return alive;
}

float PathIntegrator::number(const PathLane& lane, std::uint32_t dimension) const {
    return to_unit_float(strategy_.value(lane.base[dimension], lane.pixel, lane.sample, dimension));
}

Vec2 PathIntegrator::pair(const PathLane& lane, std::uint32_t dimension) const {
    return {number(lane, dimension), number(lane, dimension + 1)};
}

bool PathIntegrator::weighs_both(bool diffuse) const {
    return settings_.lights == LightSampling::mis || (settings_.lights == LightSampling::automatic && !diffuse);
}

bool PathIntegrator::may_go_on(const PathLanes& p, unsigned l, std::uint32_t vertex, bool transmission) const {
    return vertex < settings_.bounces && (transmission ? p.transmissions[l] < settings_.bounces_transmission
                                                       : p.reflections[l] < settings_.bounces_diffuse);
}

IntegratorEntry path_integrator() {
    return {"path", "path tracing: emitters, sun and sky by shadow and bounce rays (--lights)",
            [](const PathSettings& settings) { return path_dimensions(settings.bounces); },
            [](const IntegratorInput& input) -> std::unique_ptr<Integrator> {
                return std::make_unique<PathIntegrator>(input);
            },
            [](const PathSettings& settings, const Lights& lights) -> StagePlan {
                // Without shadow rays a last ray of each path looks for the lights.
                const bool shadows = !lights.empty() && settings.lights != LightSampling::bsdf;
                return {settings.bounces + (!lights.empty() && !shadows ? 1 : 0), shadows};
            }};
}

}  // namespace raycache::tracer
