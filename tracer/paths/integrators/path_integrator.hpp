// A path tracer, in megakernel order: camera rays; then per path vertex texel reads where the surface is textured (of
// its emission, where that counts; of what it reflects; of a textured light aimed at), a shadow ray, a bounce ray. Surfaces: Lambert's, done here, and those of bsdf/. Emitters, sun and sky: LightSampling.
// Lanes that have left the scene or whose throughput is black stay idle until the warp ends.
//
// Dimensions of a sample, in pairs: (0,1) position in the pixel; vertex b = 0, 1, …: (2+4b, 3+4b) point on a light,
// (4+4b, 5+4b) bounce direction, whose first number also chooses among the lobes of a surface; behind all vertices one
// dimension each for Russian roulette.
#pragma once

#include <array>
#include <cstdint>

#include "tracer/paths/integrators/integrator.hpp"

namespace raycache::tracer {

/// Sample dimensions that a path of `bounces` bounces needs.
inline std::uint32_t path_dimensions(std::uint32_t bounces) { return 2 + 5 * (bounces + 1); }

class PathIntegrator final : public Integrator, public PathStages {
public:
    explicit PathIntegrator(const IntegratorInput& input)
        : scene_(input.scene),
          camera_(input.camera),
          lights_(input.lights),
          texels_(input.texels),
          strategy_(input.strategy),
          settings_(input.settings),
          traversal_(input.traversal) {}

    void trace(std::uint32_t mask, const std::array<PathLane, PathLanes::count>& jobs,
               std::array<Vec3, PathLanes::count>& radiance) override;

    PathStages* stages() override { return this; }
    void generate(std::uint32_t mask, PathLanes&) const override;
    std::uint32_t arrive(std::uint32_t mask, std::uint32_t vertex, PathLanes&) override;
    /// Diffuse surfaces multiply their reflectance in, and lanes on black ones end; the others leave
    /// PathLanes::shading.
    std::uint32_t shade(std::uint32_t mask, std::uint32_t vertex, PathLanes&) override;
    std::uint32_t aim_at_light(std::uint32_t mask, std::uint32_t vertex, PathLanes&) override;
    void collect_light(std::uint32_t unblocked, PathLanes&) const override;
    /// Paths end at their last vertex, where the direction points below the surface or nothing comes from it, and by
    /// roulette.
    std::uint32_t scatter(std::uint32_t mask, std::uint32_t vertex, PathLanes&) const override;

private:
    float number(const PathLane&, std::uint32_t dimension) const;
    Vec2 pair(const PathLane&, std::uint32_t dimension) const;
    /// What the emission of a material is multiplied with at (u, v) of a triangle.
    TexelLayout::Texel emission_texel(const Material&, std::uint32_t triangle, float u, float v) const;
    /// Whether light is sought by shadow and bounce rays both.
    bool weighs_both(bool diffuse) const;
    /// Whether there is a next vertex behind a bounce of this kind.
    bool may_go_on(const PathLanes&, unsigned lane, std::uint32_t vertex, bool transmission) const;

    const Scene& scene_;
    const CameraRays& camera_;
    const Lights& lights_;
    const TexelLayout& texels_;
    const SamplingStrategy& strategy_;
    const PathSettings settings_;
    Traversal& traversal_;

    PathLanes lanes_;
};

}  // namespace raycache::tracer
