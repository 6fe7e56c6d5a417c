// A report under the names of Nsight Compute's metrics, to be laid beside a profile.
#pragma once

#include <string>
#include <vector>

#include "cachesim/report/profiler_metrics.hpp"
#include "cachesim/report/report.hpp"

namespace raycache::cachesim {

/// A series with what only a profiler's metrics need.
struct ProfiledSeries : Series {
    std::vector<LaunchStatistics> instructions;  ///< of each launch: L2RequestCounter::in_instructions()
    std::vector<TimedStatistics> times;          ///< likewise; empty: not replayed in time
};

/// The totals of every row. All GPUs must have two levels: the profiler has no name for one between L1 and the shared.
struct ProfilerReport {
    Report report;
    std::vector<ProfileCounts> counts;  ///< by row

    /// Those that some row has a number for.
    std::vector<ProfilerMetric> metrics() const;
};

/// Throws UsageError as make_report() does. With times all launches must be one group: GroupBy::none.
ProfilerReport make_profile(const std::vector<ProfiledSeries>&, const Baseline& baseline, GroupBy);

/// The same of one launch of a series.
ProfilerReport make_profile(const ProfiledSeries&, std::size_t launch);

/// Two decimals for what is no count; `none` where there is no value.
std::string to_string(const MetricValue&, const char* none);

std::string to_text(const ProfilerReport&);
/// {"by", "rows": [{"scene", …, "samples", "metrics": [{"name", "value", "unit"}]}]}; null where nothing was counted.
std::string to_json(const ProfilerReport&);
/// A line per row, a column per metric.
std::string to_csv(const ProfilerReport&);

}  // namespace raycache::cachesim
