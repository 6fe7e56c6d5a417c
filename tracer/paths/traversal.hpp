// Who walks the rays of an integrator, a warp at a time: WarpTraversal in captures (RegionTraversal where no BVH is
// walked), EmbreeTraversal in renders.
#pragma once

#include <cstdint>

#include "tracer/ray.hpp"
#include "traces/record.hpp"

namespace raycache::tracer {

/// Arrays have one entry per lane; those outside `mask` are neither read nor written.
class Traversal {
public:
    virtual ~Traversal() = default;

    /// Nearest hit of each lane in `mask`. Texels with alpha below the cutoff are holes.
    virtual void closest(std::uint32_t mask, traces::RayType, std::uint8_t bounce, const Ray* rays, Hit* hits) = 0;
    /// Lanes whose ray meets anything in (t_min, t_max].
    virtual std::uint32_t occluded(std::uint32_t mask, traces::RayType, std::uint8_t bounce, const Ray* rays) = 0;
    /// The lanes of `mask` each read one texel for shading; lane l reads `elements[l]`.
    virtual void read_texels(std::uint32_t mask, traces::RayType, std::uint8_t bounce,
                             const std::uint32_t* elements) = 0;

    // Of integrators that read memory of their own (IntegratorData::regions()). Nothing is recorded by default.
    /// The lanes of `mask` each begin a ray that walks no BVH: what they read next belongs to it.
    virtual void start(std::uint32_t /*mask*/, traces::RayType, std::uint8_t /*bounce*/) {}
    /// The lanes of `mask` each read one element of the integrator's region `region`; lane l reads `elements[l]`.
    virtual void read_region(std::uint32_t /*mask*/, traces::RayType, std::uint8_t /*bounce*/, std::uint8_t /*region*/,
                             const std::uint32_t* /*elements*/) {}
};

}  // namespace raycache::tracer
