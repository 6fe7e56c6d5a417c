// What can be told of a strategy by tracing alone: rays and accesses of every kind, without a cache.
//
// Time and bytes are work x cost per access. The work scatters most, from one sample index to the next and from place
// to place, and tracing is cheap: so it is measured over many places, the cost per access over few windows, and the
// windows' counts are scaled to the work.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "cachesim/gpus/gpu.hpp"
#include "cachesim/replay/statistics.hpp"
#include "cachesim/replay/timed/timed_statistics.hpp"
#include "traces/header.hpp"
#include "traces/record.hpp"

namespace raycache::tools {

class WorkCount {
public:
    /// `regions`: of the traces. `simd_widths`: of the machines whose vectors are counted, besides warps.
    WorkCount(const std::vector<traces::Region>& regions, std::vector<std::uint32_t> simd_widths);

    void add(const traces::WarpTrace&);

    std::uint64_t rays() const { return rays_; }

    /// A launch of the work counted here, times `scale`. What an SM's own caches do is that of `of_sms`, what all SMs
    /// share that of `windows`: counts per access, by ray type, bounce and kind of object (post-stratification: Cochran,
    /// Sampling Techniques, 1977, section 5A.9). Accesses that neither met are charged as their kind is on average.
    std::vector<cachesim::RayGroup> launch(const cachesim::LaunchStatistics& of_sms,
                                           const cachesim::LaunchStatistics& windows, const cachesim::Gpu&,
                                           double scale) const;
    /// Time has no parts: scales everything to the warp accesses here, times `scale`.
    void scale(cachesim::TimedStatistics&, double scale) const;

private:
    struct Accesses {
        std::uint64_t warps = 0, lanes = 0;
        std::vector<std::uint64_t> vectors;  ///< by width
    };
    struct Group {
        std::uint64_t rays = 0;
        std::array<Accesses, traces::object_kinds> kinds;
    };
    static std::size_t place(traces::RayType ray, unsigned bounce) {
        return static_cast<std::size_t>(ray) * (traces::max_bounce + 1) + bounce;
    }
    double accesses(const Accesses&, std::uint32_t simd_width) const;

    std::vector<traces::ObjectKind> kinds_;  ///< by region
    std::vector<std::uint32_t> widths_;
    std::vector<Group> groups_;  ///< by place()
    std::uint64_t rays_ = 0, warp_accesses_ = 0;
};

}  // namespace raycache::tools
