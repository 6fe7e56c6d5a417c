// What is computed along the rays of a pixel, for the lanes of a warp at a time. One file per integrator in this
// folder, one line each in registry.cpp.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "tracer/bvh/embree_scene.hpp"
#include "tracer/paths/camera_rays.hpp"
#include "tracer/paths/lights.hpp"
#include "tracer/paths/path_lanes.hpp"
#include "tracer/paths/path_settings.hpp"
#include "tracer/paths/traversal.hpp"
#include "tracer/sampling/sampling_strategy.hpp"
#include "tracer/scene/scene.hpp"
#include "tracer/scene/texel_layout.hpp"
#include "traces/header.hpp"

namespace raycache::tracer {

/// The stages of a path, in this order per vertex, for executions that walk rays between them
/// (tracer/simt/wavefront.hpp). Each works on the lanes of `mask`, all at the same vertex (0 = where the camera ray
/// ends), and returns the lanes that go on. They keep nothing between calls but what is in PathLanes.
class PathStages {
public:
    virtual ~PathStages() = default;

    /// Camera rays of `p.job`.
    virtual void generate(std::uint32_t mask, PathLanes& p) const = 0;
    /// From `p.hits`: adds the light that the rays met, reading textures of emission through the traversal, returns the
    /// lanes that hit a surface; the others end.
    virtual std::uint32_t arrive(std::uint32_t mask, std::uint32_t vertex, PathLanes& p) = 0;
    /// Reads textures, through the traversal; lanes on surfaces that reflect nothing end.
    virtual std::uint32_t shade(std::uint32_t mask, std::uint32_t vertex, PathLanes& p) = 0;
    /// Fills `p.shadow_rays` and `p.contribution` of the lanes returned: those that a light may reach. Reads textures
    /// of emission through the traversal.
    virtual std::uint32_t aim_at_light(std::uint32_t mask, std::uint32_t vertex, PathLanes& p) = 0;
    /// Adds the light of the lanes whose shadow ray met nothing.
    virtual void collect_light(std::uint32_t unblocked, PathLanes& p) const = 0;
    /// Chooses the next ray.
    virtual std::uint32_t scatter(std::uint32_t mask, std::uint32_t vertex, PathLanes& p) const = 0;
};

/// Belongs to one thread.
class Integrator {
public:
    virtual ~Integrator() = default;

    /// Computes one sample per lane of `mask`, one ray after the other, all lanes together, as a warp of a megakernel
    /// does. `radiance` receives each lane's estimate.
    virtual void trace(std::uint32_t mask, const std::array<PathLane, PathLanes::count>& jobs,
                       std::array<Vec3, PathLanes::count>& radiance) = 0;

    /// Null where it is not cut into stages.
    virtual PathStages* stages() { return nullptr; }
};

/// What an integrator works out once for all threads of a capture or a render, and which memory of its own it reads.
class IntegratorData {
public:
    virtual ~IntegratorData() = default;
    /// Regions that are neither BVH nor textures: kind, sizes and counts. A capture places them in memory, and
    /// Traversal::read_region() names them by their place in this list.
    virtual std::vector<traces::Region> regions() const { return {}; }
};

/// What it is worked out from.
struct IntegratorSetup {
    const Scene& scene;
    const CameraRays& camera;
    const PathSettings& settings;
    std::function<const EmbreeScene&()> embree;  ///< built when it is first asked for
};

/// What an integrator is made of; everything but the settings must outlive it.
struct IntegratorInput {
    const Scene& scene;
    const CameraRays& camera;
    const Lights& lights;
    const TexelLayout& texels;
    const SamplingStrategy& strategy;
    const PathSettings& settings;
    Traversal& traversal;
    const IntegratorData* data = nullptr;  ///< what IntegratorEntry::prepare made; null without one
};

/// How often the stages of a path come.
struct StagePlan {
    std::uint32_t last_vertex = 0;  ///< the highest that a ray may reach
    bool shadow_rays = false;       ///< whether aim_at_light() ever returns lanes
};

struct IntegratorEntry {
    std::string name, description;
    /// How many sample dimensions a path needs.
    std::uint32_t (*dimensions)(const PathSettings&);
    std::unique_ptr<Integrator> (*make)(const IntegratorInput&);
    /// Null where it is not cut into stages: it then runs as a megakernel alone.
    StagePlan (*stages)(const PathSettings&, const Lights&);

    bool follows_light = true;  ///< reads bounces and their limits, lights, roulette; without, these have no effect
    bool walks_bvh = true;      ///< false: it asks its Traversal for start() and read_region() alone
    /// What it may be given (PathSettings::parameters). Integrators may have one of a name in common.
    std::vector<ParameterEntry> parameters = {};
    /// Null: it needs nothing of the kind.
    std::shared_ptr<const IntegratorData> (*prepare)(const IntegratorSetup&) = nullptr;

    bool has_parameter(const std::string& name) const;
};
const std::vector<IntegratorEntry>& integrators();

/// Throws UsageError for an unknown name: lists the valid ones, and the closest.
const IntegratorEntry& integrator_entry(const std::string& name);

/// The parameters of all integrators, each name once.
const std::vector<ParameterEntry>& integrator_parameters();
/// The one of that name. Throws UsageError for an unknown name: lists the valid ones, and the closest.
const ParameterEntry& integrator_parameter(const std::string& name);

/// Of one sample, by the integrator that the settings name.
std::uint32_t sample_dimensions(const PathSettings&);

}  // namespace raycache::tracer
