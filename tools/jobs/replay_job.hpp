// The job "replay": launches through GPUs, counted or in time. raycache replay and compare print reports of its result.
#pragma once

#include <optional>
#include <vector>

#include "cachesim/report/profiler.hpp"
#include "cachesim/report/report.hpp"
#include "cachesim/report/timed_report.hpp"
#include "tools/jobs/gpu_settings.hpp"
#include "tools/jobs/launches.hpp"
#include "tools/jobs/windows/estimate.hpp"

namespace raycache::tools {

struct ReplayJob {
    LaunchSettings launches;
    GpuSettings gpu;
    bool timed = false;  ///< predict cycles, too
    EstimateSettings estimate{};
};

struct ReplayResult {
    Subject subject;
    /// One per source and GPU, sources first: what make_report() takes.
    std::vector<cachesim::Series> series;
    std::vector<cachesim::TimedSeries> times;          ///< in the same order; none unless asked for
    std::vector<cachesim::ColdLaunches> cold;          ///< likewise
    std::optional<cachesim::FidelityChoice> fidelity;  ///< where a pilot was to choose
};

/// What make_profile() takes.
struct ProfileResult {
    Subject subject;
    std::vector<cachesim::ProfiledSeries> series;  ///< one per source and GPU, sources first
};

/// The job with what a profiler's metrics need, of whole launches: job.estimate must ask for no windows. The rest as
/// run().
ProfileResult profile(const ReplayJob&, const std::vector<cachesim::Gpu>& gpus, Observer&,
                      const FileNames& outputs = {});

/// `gpus`: those of job.gpu. `outputs`: files that the caller is going to write, refused where the job reads one of
/// them. Throws UsageError for settings that make no sense, else Error as Launches does.
ReplayResult run(const ReplayJob&, const std::vector<cachesim::Gpu>& gpus, Observer&, const FileNames& outputs = {});
/// The same with the GPUs loaded. Also throws as GpuSettings::load() does.
ReplayResult run(const ReplayJob&, Observer&, const FileNames& outputs = {});

}  // namespace raycache::tools
