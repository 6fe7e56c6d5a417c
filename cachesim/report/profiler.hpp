// A report under the names of Nsight Compute's metrics, to be laid beside a profile.
#pragma once

#include <string>

#include "cachesim/report/report.hpp"

namespace raycache::cachesim {

/// The totals of every row. All GPUs must have two levels: the profiler has no name for one between L1 and the shared.
struct ProfilerReport {
    Report report;
};

std::string to_text(const ProfilerReport&);
/// {"by", "rows": [{"scene", …, "samples", "metrics": {NAME: value}}]}; null where nothing was counted.
std::string to_json(const ProfilerReport&);
/// A line per row, a column per metric.
std::string to_csv(const ProfilerReport&);

}  // namespace raycache::cachesim
