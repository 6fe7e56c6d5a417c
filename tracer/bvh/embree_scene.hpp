// The scene in Embree: its own BVH and its robust ray queries over the same triangles. Renders walk their rays with it,
// tests and benchmarks take it as the referee, and buffers that an integrator reads are drawn by it; the rays of a
// capture are not walked so, since it needs the walk itself.
#pragma once

#include <cstdint>
#include <memory>

#include "tracer/ray.hpp"
#include "tracer/scene/scene.hpp"
#include "tracer/scene/texel_layout.hpp"

namespace raycache::tracer {

class EmbreeParts;

/// Both arguments must outlive it. The tree is built on one thread, so equal scenes give equal answers, also where
/// triangles coincide.
class EmbreeScene {
public:
    explicit EmbreeScene(const Scene&);             ///< opaque: holes of alpha-masked materials are not cut out
    EmbreeScene(const Scene&, const TexelLayout&);  ///< with the holes that WarpTraversal sees
    ~EmbreeScene();
    EmbreeScene(const EmbreeScene&) = delete;
    EmbreeScene& operator=(const EmbreeScene&) = delete;

    /// Nearest hit in (t_min, t_max]: rtcIntersect1. Agrees with WarpTraversal within rounding; of triangles at one
    /// distance it may name another.
    Hit intersect(const Ray&) const;
    bool occluded(const Ray&) const;  ///< rtcOccluded1

private:
    std::unique_ptr<EmbreeParts> parts_;
};

}  // namespace raycache::tracer
