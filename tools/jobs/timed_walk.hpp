// A log of rays walked by Embree several times on the calling thread, with the time that each takes.
#pragma once

#include <cstdint>
#include <vector>

#include "tools/jobs/hardware_counters.hpp"
#include "tracer/bvh/embree_walker.hpp"
#include "tracer/simt/ray_log.hpp"

namespace raycache::tools {

class TimedWalk {
public:
    /// Both must outlive it.
    TimedWalk(const tracer::RayLog& log, const tracer::WalkMode& mode) : log_(&log), mode_(&mode) {}

    /// Walks all batches in order. `warm_up`: checks the ends of the rays instead of keeping the time.
    void walk(const tracer::EmbreeWalker&, HardwareCounters&, bool warm_up);

    const tracer::RayLog& log() const { return *log_; }
    double seconds() const;             ///< median of all walks but the warm-up
    double counter(std::size_t) const;  ///< the same of a hardware counter
    /// Rays that ended elsewhere than in the log: hit and no hit, or further apart than rounding explains.
    std::uint64_t other_ends() const { return other_ends_; }

private:
    const tracer::RayLog* log_;
    const tracer::WalkMode* mode_;
    std::vector<double> seconds_;
    std::vector<std::vector<double>> counts_;  ///< by walk, by counter
    std::uint64_t other_ends_ = 0;
};

}  // namespace raycache::tools
