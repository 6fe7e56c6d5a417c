// The job "explain": why one of two strategies, or traces, is kinder to a GPU's caches than the other.
#pragma once

#include <vector>

#include "cachesim/report/explanation.hpp"
#include "tools/jobs/gpu_settings.hpp"
#include "tools/jobs/heat_map.hpp"
#include "tools/jobs/launches.hpp"
#include "tools/jobs/windows/estimate.hpp"

namespace raycache::tools {

struct ExplainJob {
    LaunchSettings launches;  ///< two: base and other, of one kernel each
    GpuSettings gpu;          ///< one
    cachesim::GroupBy by = cachesim::GroupBy::none;
    bool timed = true;    ///< predict times, if the GPU has a [timing]
    bool pixels = false;  ///< also heat maps
    /// Without `baseline`: it is the first of the launches. No windows with `pixels`.
    EstimateSettings estimate{};

    /// Throws UsageError unless the launches are two, for heat maps of windows, and as LaunchSettings::check() and, with
    /// windows, check_windows() do.
    void check() const;
};

struct ExplainResult {
    Subject subject;
    cachesim::Explanation explanation;
    std::vector<HeatMap> maps;  ///< of base and other; none unless asked for
};

/// `gpu`: that of job.gpu. `outputs` as in replay_job.hpp. Throws as explain_launches() and Launches do.
ExplainResult run(const ExplainJob&, const cachesim::Gpu& gpu, Observer&, const FileNames& outputs = {});
/// The same with the GPU loaded. Also throws as GpuSettings::load_one() does.
ExplainResult run(const ExplainJob&, Observer&, const FileNames& outputs = {});

}  // namespace raycache::tools
