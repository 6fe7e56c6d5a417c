// The job "curve": what caches of every size would have done, from one replay of each launch.
#pragma once

#include <cstdint>
#include <vector>

#include "cachesim/report/curve_report.hpp"
#include "tools/jobs/gpu_settings.hpp"
#include "tools/jobs/launches.hpp"

namespace raycache::tools {

struct CurveJob {
    LaunchSettings launches;           ///< of one kernel each
    GpuSettings gpu;                   ///< one
    std::vector<std::size_t> levels;   ///< 0: L1; none: all of the GPU
    std::vector<std::uint64_t> sets;   ///< of a slice; beside the GPU's own and full associativity
    std::vector<std::uint64_t> sizes;  ///< bytes of a cache, for the table; none: as table_sizes() says
    /// Beside lru, at `sizes` or a few sizes around the GPU's own: names of cache_policies(), and "belady".
    std::vector<std::string> policies;

    /// Below 1: estimates from so large a share of all lines, of fully associative caches (LruSurface). Not beside sets
    /// and policies, and not for levels of fewer than WaysCurve::fewest_sampled_lines lines.
    double rate = 1;

    /// Names that policies may have.
    static std::vector<std::string> policy_names();
    /// Throws UsageError for a policy of no such name, for a level that the GPU has not, for sizes with more levels
    /// than one and for one that is no whole number of ways of the GPU's own sets, and as LaunchSettings::check() does.
    void check(const cachesim::Gpu&) const;
};

struct CurveResult {
    Subject subject;
    std::vector<cachesim::CurveSeries> series;  ///< one per source
};

/// `gpu`: that of job.gpu. `outputs` as in replay_job.hpp. Throws as check(), Launches and refuse_wavefront() do. The
/// result does not depend on the number of threads.
CurveResult run(const CurveJob&, const cachesim::Gpu& gpu, Observer&, const FileNames& outputs = {});

}  // namespace raycache::tools
