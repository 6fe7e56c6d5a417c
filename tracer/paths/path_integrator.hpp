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

/// What a lane works on.
struct PathLane {
    std::uint32_t x = 0, y = 0;
    std::uint32_t pixel = 0;              ///< y * width + x: identifies the pixel to the decorrelation
    std::uint32_t sample = 0;             ///< sample index
    const std::uint32_t* base = nullptr;  ///< SamplingStrategy::base_point(sample)
};

template <class Traversal>
class PathIntegrator {
public:
    static constexpr unsigned lanes = traces::warp_lanes;

    PathIntegrator(const Scene& scene, const CameraRays& camera, const Lights& lights, const TexelLayout& texels,
                   const SamplingStrategy& strategy, const PathSettings& settings, Traversal& traversal)
        : scene_(scene),
          camera_(camera),
          lights_(lights),
          texels_(texels),
          strategy_(strategy),
          settings_(settings),
          traversal_(traversal) {}

    /// Traces one path per lane of `mask`; adds nothing elsewhere. `radiance` receives each lane's estimate.
    void trace(std::uint32_t mask, const std::array<PathLane, lanes>& job, std::array<Vec3, lanes>& radiance) {
        job_ = &job;
        radiance_ = &radiance;
        for_each(mask, [&](unsigned l) {
            rays_[l] = camera_.ray(job[l].x, job[l].y, pair(l, 0));
            throughput_[l] = {1, 1, 1};
            radiance[l] = {};
        });
        traversal_.closest(mask, traces::RayType::camera, 0, rays_, hits_);
        std::uint32_t alive = arrive(mask, 0);
        for (std::uint32_t vertex = 0; alive != 0; ++vertex) {
            alive = shade(alive, vertex);
            connect_to_light(alive, vertex);
            if (vertex == settings_.bounces) break;
            alive = scatter(alive, vertex);
            if (alive == 0) break;
            traversal_.closest(alive, traces::RayType::bounce, static_cast<std::uint8_t>(vertex + 1), rays_, hits_);
            alive = arrive(alive, vertex + 1);
        }
    }

private:
    template <class Body>
    static void for_each(std::uint32_t mask, Body body) {
        for (; mask != 0; mask &= mask - 1) body(static_cast<unsigned>(std::countr_zero(mask)));
    }

    float number(unsigned l, std::uint32_t dimension) const {
        const PathLane& lane = (*job_)[l];
        return to_unit_float(strategy_.value(lane.base[dimension], lane.pixel, lane.sample, dimension));
    }
    Vec2 pair(unsigned l, std::uint32_t dimension) const { return {number(l, dimension), number(l, dimension + 1)}; }

    static traces::RayType type_of(std::uint32_t vertex) {
        return vertex == 0 ? traces::RayType::camera : traces::RayType::bounce;
    }

    /// Lanes that hit a surface; the others see the sky.
    std::uint32_t arrive(std::uint32_t mask, std::uint32_t vertex) {
        std::uint32_t hit = 0;
        for_each(mask, [&](unsigned l) {
            if (!hits_[l].found()) {
                (*radiance_)[l] += throughput_[l] * scene_.sky;
                return;
            }
            hit |= 1U << l;
            surface_[l] = surface_at(scene_, rays_[l], hits_[l]);
            // Later vertices meet emitters by shadow rays only.
            if (vertex == 0) (*radiance_)[l] += surface_[l].material->emission;
        });
        return hit;
    }

    /// Reads textures and multiplies the reflectance in. Lanes on black surfaces end.
    std::uint32_t shade(std::uint32_t mask, std::uint32_t vertex) {
        std::uint32_t textured = 0, alive = 0;
        std::uint32_t element[lanes];
        for_each(mask, [&](unsigned l) {
            const Material& material = *surface_[l].material;
            Vec3 reflectance = material.base_color;
            if (material.base_color_texture >= 0) {
                const Hit& hit = hits_[l];
                const auto texel =
                    texels_.fetch(material.base_color_texture, texcoord_at(scene_, hit.triangle, hit.u, hit.v));
                element[l] = texel.element;
                reflectance *= texel.color;
                textured |= 1U << l;
            }
            throughput_[l] *= reflectance;
            if (max_component(throughput_[l]) > 0) alive |= 1U << l;
        });
        if (textured != 0)
            traversal_.read_texels(textured, type_of(vertex), static_cast<std::uint8_t>(vertex), element);
        return alive;
    }

    void connect_to_light(std::uint32_t mask, std::uint32_t vertex) {
        if (lights_.empty()) return;
        Ray rays[lanes];
        Vec3 contribution[lanes];
        std::uint32_t shadow = 0;
        for_each(mask, [&](unsigned l) {
            const Surface& s = surface_[l];
            const LightSample light = lights_.sample(s.position, pair(l, 2 + 4 * vertex));
            const float cosine = dot(s.shading_normal, light.direction);
            if (!(cosine > 0) || !(dot(s.geometric_normal, light.direction) > 0)) return;
            contribution[l] = throughput_[l] * light.radiance_over_pdf * (cosine * std::numbers::inv_pi_v<float>);
            if (!(max_component(contribution[l]) > 0)) return;
            constexpr float short_of_light = 0.9999F;
            rays[l] = {s.leave(light.direction), light.direction, 0, light.distance * short_of_light};
            shadow |= 1U << l;
        });
        if (shadow == 0) return;
        const std::uint32_t blocked =
            traversal_.occluded(shadow, traces::RayType::shadow, static_cast<std::uint8_t>(vertex), rays);
        for_each(shadow & ~blocked, [&](unsigned l) { (*radiance_)[l] += contribution[l]; });
    }

    /// Chooses the next direction. Lanes whose direction points below the surface, or that lose at roulette, end.
    std::uint32_t scatter(std::uint32_t mask, std::uint32_t vertex) {
        std::uint32_t alive = 0;
        for_each(mask, [&](unsigned l) {
            const Surface& s = surface_[l];
            // Cosine-distributed on a diffuse surface: reflectance is the whole weight.
            const Vec3 direction = to_world(cosine_hemisphere(pair(l, 4 + 4 * vertex)), s.shading_normal);
            if (!(dot(direction, s.geometric_normal) > 0)) return;
            if (settings_.russian_roulette && vertex >= 2) {
                const float survival = std::min(0.95F, max_component(throughput_[l]));
                if (number(l, 2 + 4 * (settings_.bounces + 1) + vertex) >= survival) return;
                throughput_[l] = throughput_[l] / survival;
            }
            rays_[l] = {s.leave(direction), direction, 0, std::numeric_limits<float>::infinity()};
            alive |= 1U << l;
        });
        return alive;
    }

    const Scene& scene_;
    const CameraRays& camera_;
    const Lights& lights_;
    const TexelLayout& texels_;
    const SamplingStrategy& strategy_;
    PathSettings settings_;
    Traversal& traversal_;

    const std::array<PathLane, lanes>* job_ = nullptr;
    std::array<Vec3, lanes>* radiance_ = nullptr;
    Ray rays_[lanes];
    Hit hits_[lanes];
    Surface surface_[lanes];
    Vec3 throughput_[lanes];
};

}  // namespace raycache::tracer
