// A path tracer for the lanes of one warp, in megakernel order: camera rays; then per path vertex a texel read where
// the surface is textured, a shadow ray, a bounce ray. Diffuse surfaces, emitters seen directly, sky seen by camera and
// bounce rays. Lanes that have left the scene or whose throughput is black stay idle until the warp ends.
//
// Dimensions of a sample, in pairs: (0,1) position in the pixel; vertex b = 0, 1, …: (2+4b, 3+4b) point on a light,
// (4+4b, 5+4b) bounce direction; behind all vertices one dimension each for Russian roulette.
//
// Who walks the rays is a parameter, a class with
//   void closest(mask, RayType, bounce, const Ray*, Hit*);         nearest hit per lane
//   std::uint32_t occluded(mask, RayType, bounce, const Ray*);      lanes that hit anything
//   void read_texels(mask, RayType, bounce, const std::uint32_t*);  texel elements read for shading
// : WarpTraversal in captures and renders, Embree in benchmarks.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

#include "tracer/paths/camera_rays.hpp"
#include "tracer/paths/directions.hpp"
#include "tracer/paths/lights.hpp"
#include "tracer/paths/path_lanes.hpp"
#include "tracer/paths/surface.hpp"
#include "tracer/sampling/sampling_strategy.hpp"
#include "tracer/scene/scene.hpp"
#include "tracer/scene/texel_layout.hpp"
#include "traces/record.hpp"

namespace raycache::tracer {

struct PathSettings {
    std::uint32_t bounces = 3;  ///< bounce rays of a path, 0 … 64
    /// Paths end early at random from the third vertex on, by throughput. Off for comparisons: it breaks lock step.
    bool russian_roulette = false;
};
inline constexpr std::uint32_t max_bounces = 64;

/// Sample dimensions that a path of `bounces` bounces needs.
inline std::uint32_t path_dimensions(std::uint32_t bounces) { return 2 + 5 * (bounces + 1); }

template <class Traversal>
class PathIntegrator {
public:
    static constexpr unsigned lanes = PathLanes::count;

    PathIntegrator(const Scene& scene, const CameraRays& camera, const Lights& lights, const TexelLayout& texels,
                   const SamplingStrategy& strategy, const PathSettings& settings, Traversal& traversal)
        : scene_(scene),
          camera_(camera),
          lights_(lights),
          texels_(texels),
          strategy_(strategy),
          settings_(settings),
          traversal_(traversal) {}

    /// Traces one path per lane of `mask` in megakernel order; adds nothing elsewhere. `radiance` receives each lane's
    /// estimate.
    void trace(std::uint32_t mask, const std::array<PathLane, lanes>& job, std::array<Vec3, lanes>& radiance) {
        PathLanes& p = lanes_;
        for_each(mask, [&](unsigned l) { p.job[l] = job[l]; });
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

    // The stages of a path, in this order per vertex; rays are walked between them. Each works on the lanes of `mask`,
    // all at the same vertex (0 = where the camera ray ends), and returns the lanes that go on. They keep nothing
    // between calls but what is in PathLanes.

    /// Camera rays of `p.job`.
    void generate(std::uint32_t mask, PathLanes& p) const {
        for_each(mask, [&](unsigned l) {
            p.rays[l] = camera_.ray(p.job[l].x, p.job[l].y, pair(p.job[l], 0));
            p.throughput[l] = {1, 1, 1};
            p.radiance[l] = {};
        });
    }

    /// From `p.hits`: lanes that hit a surface; the others see the sky and end.
    std::uint32_t arrive(std::uint32_t mask, std::uint32_t vertex, PathLanes& p) const {
        std::uint32_t hit = 0;
        for_each(mask, [&](unsigned l) {
            if (!p.hits[l].found()) {
                p.radiance[l] += p.throughput[l] * scene_.sky;
                return;
            }
            hit |= 1U << l;
            p.surface[l] = surface_at(scene_, p.rays[l], p.hits[l]);
            // Later vertices meet emitters by shadow rays only.
            if (vertex == 0) p.radiance[l] += p.surface[l].material->emission;
        });
        return hit;
    }

    /// Reads textures (through the traversal, which records it) and multiplies the reflectance in. Lanes on black
    /// surfaces end.
    std::uint32_t shade(std::uint32_t mask, std::uint32_t vertex, PathLanes& p) {
        std::uint32_t textured = 0, alive = 0;
        std::uint32_t element[lanes];
        for_each(mask, [&](unsigned l) {
            const Material& material = *p.surface[l].material;
            Vec3 reflectance = material.base_color;
            if (material.base_color_texture >= 0) {
                const Hit& hit = p.hits[l];
                const auto texel =
                    texels_.fetch(material.base_color_texture, texcoord_at(scene_, hit.triangle, hit.u, hit.v));
                element[l] = texel.element;
                reflectance *= texel.color;
                textured |= 1U << l;
            }
            p.throughput[l] *= reflectance;
            if (max_component(p.throughput[l]) > 0) alive |= 1U << l;
        });
        if (textured != 0)
            traversal_.read_texels(textured, type_of(vertex), static_cast<std::uint8_t>(vertex), element);
        return alive;
    }

    /// Fills `p.shadow_rays` and `p.contribution` of the lanes returned: those that a light may reach.
    std::uint32_t aim_at_light(std::uint32_t mask, std::uint32_t vertex, PathLanes& p) const {
        if (lights_.empty()) return 0;
        std::uint32_t shadow = 0;
        for_each(mask, [&](unsigned l) {
            const Surface& s = p.surface[l];
            const LightSample light = lights_.sample(s.position, pair(p.job[l], 2 + 4 * vertex));
            const float cosine = dot(s.shading_normal, light.direction);
            if (!(cosine > 0) || !(dot(s.geometric_normal, light.direction) > 0)) return;
            p.contribution[l] = p.throughput[l] * light.radiance_over_pdf * (cosine * std::numbers::inv_pi_v<float>);
            if (!(max_component(p.contribution[l]) > 0)) return;
            constexpr float short_of_light = 0.9999F;
            p.shadow_rays[l] = {s.leave(light.direction), light.direction, 0, light.distance * short_of_light};
            shadow |= 1U << l;
        });
        return shadow;
    }

    /// Adds the light of the lanes whose shadow ray met nothing.
    void collect_light(std::uint32_t unblocked, PathLanes& p) const {
        for_each(unblocked, [&](unsigned l) { p.radiance[l] += p.contribution[l]; });
    }

    /// Chooses the next direction. Paths of the last vertex end, and those whose direction points below the surface or
    /// that lose at roulette.
    std::uint32_t scatter(std::uint32_t mask, std::uint32_t vertex, PathLanes& p) const {
        if (vertex == settings_.bounces) return 0;
        std::uint32_t alive = 0;
        for_each(mask, [&](unsigned l) {
            const Surface& s = p.surface[l];
            // Cosine-distributed on a diffuse surface: reflectance is the whole weight.
            const Vec3 direction = to_world(cosine_hemisphere(pair(p.job[l], 4 + 4 * vertex)), s.shading_normal);
            if (!(dot(direction, s.geometric_normal) > 0)) return;
            if (settings_.russian_roulette && vertex >= 2) {
                const float survival = std::min(0.95F, max_component(p.throughput[l]));
                if (number(p.job[l], 2 + 4 * (settings_.bounces + 1) + vertex) >= survival) return;
                p.throughput[l] = p.throughput[l] / survival;
            }
            p.rays[l] = {s.leave(direction), direction, 0, std::numeric_limits<float>::infinity()};
            alive |= 1U << l;
        });
        return alive;
    }

private:
    template <class Body>
    static void for_each(std::uint32_t mask, Body body) {
        for (; mask != 0; mask &= mask - 1) body(static_cast<unsigned>(std::countr_zero(mask)));
    }

    float number(const PathLane& lane, std::uint32_t dimension) const {
        return to_unit_float(strategy_.value(lane.base[dimension], lane.pixel, lane.sample, dimension));
    }
    Vec2 pair(const PathLane& lane, std::uint32_t dimension) const {
        return {number(lane, dimension), number(lane, dimension + 1)};
    }

    static traces::RayType type_of(std::uint32_t vertex) {
        return vertex == 0 ? traces::RayType::camera : traces::RayType::bounce;
    }

    const Scene& scene_;
    const CameraRays& camera_;
    const Lights& lights_;
    const TexelLayout& texels_;
    const SamplingStrategy& strategy_;
    PathSettings settings_;
    Traversal& traversal_;

    PathLanes lanes_;
};

}  // namespace raycache::tracer
