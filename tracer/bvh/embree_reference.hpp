// Embree as the referee: its own BVH and its robust ray queries over the same triangles. Used by tests and benchmarks,
// never by a capture.
#pragma once

#include <cstdint>
#include <memory>

#include "tracer/ray.hpp"
#include "tracer/scene/scene.hpp"

namespace raycache::tracer {

class EmbreeReference {
public:
    explicit EmbreeReference(const Scene&);  ///< opaque: holes of alpha-masked materials are not cut out
    ~EmbreeReference();
    EmbreeReference(const EmbreeReference&) = delete;
    EmbreeReference& operator=(const EmbreeReference&) = delete;

    Hit intersect(const Ray&) const;  ///< rtcIntersect1
    bool occluded(const Ray&) const;  ///< rtcOccluded1

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace raycache::tracer
