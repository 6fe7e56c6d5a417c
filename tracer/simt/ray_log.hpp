// The rays of a launch in the order in which warps start them, without the walk: for programs that walk the same rays
// by other means. They are the rays of a capture of the same settings, bit for bit, and so are their counts.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "tracer/capture.hpp"
#include "tracer/ray.hpp"
#include "traces/record.hpp"

namespace raycache::tracer {

/// Rays that the lanes of one warp start together, lowest lane first: entries [first, first + count) of the log.
struct RayBatch {
    std::uint32_t warp = 0;
    traces::RayType type = traces::RayType::camera;
    std::uint8_t bounce = 0;  ///< as in traces::Record
    std::uint32_t count = 0;  ///< 1 … 32
    std::uint64_t first = 0;

    bool any_hit() const { return type == traces::RayType::shadow; }
    bool operator==(const RayBatch&) const = default;
};

struct RayLog {
    std::vector<RayBatch> batches;
    std::vector<Ray> rays;
    /// Where the tracer's own walk ended: the t of the nearest hit, infinity without one; of shadow rays 0 where
    /// anything is in the way, else infinity.
    std::vector<float> ends;

    std::uint64_t bytes() const {
        return batches.size() * sizeof(RayBatch) + rays.size() * (sizeof(Ray) + sizeof(float));
    }
};

/// What the tracer's own walk found, beside RayLog::ends.
struct RayHits {
    struct Hole {
        std::uint64_t ray;       ///< entry of the log
        std::uint32_t triangle;  ///< of the scene: met, and passed through
        bool operator==(const Hole&) const = default;
    };
    std::vector<std::uint32_t> masks;      ///< of each batch: its lanes
    std::vector<std::uint32_t> triangles;  ///< of each ray: that of the nearest hit; no_triangle: none, or a shadow ray
    std::vector<Hole> holes;               ///< in the order of rays

    std::uint64_t bytes() const {
        return (masks.size() + triangles.size()) * sizeof(std::uint32_t) + holes.size() * sizeof(Hole);
    }
};

/// A launch, traced on all threads of the current TBB arena; the result does not depend on their number. Of a
/// megakernel the batches come warp by warp. Of a wavefront they come kernel by kernel, the warps of each in order;
/// RayBatch::warp counts within the kernel. `hits`: written where it is not null.
RayLog log_rays(const Capture&, std::uint32_t launch, RayHits* hits = nullptr);

/// The batches for which `is_wanted` holds, and their rays.
RayLog only(const RayLog&, const std::function<bool(const RayBatch&)>& is_wanted);

/// The same batches with the rays dealt anew, each to a place of its kind (nearest hit or any hit): what is left of a
/// strategy when the order of its rays is not.
RayLog shuffled(const RayLog&, std::uint64_t seed);

}  // namespace raycache::tracer
