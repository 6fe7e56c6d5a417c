// What "measure" found, as a table for people, JSON and CSV.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "cachesim/analysis/estimate.hpp"
#include "tools/jobs/measure_job.hpp"

namespace raycache::tools {

struct MeasureRow {
    const MeasuredWalk* walk;
    cachesim::Estimate mrays_per_second, ns_per_ray;
    /// Over the baseline with the same N, sequence, mode, order and group; absent for the baseline itself. Per ray:
    /// seconds a ray of the baseline over this one's. Per index: seconds of the sample indices over this one's, so that
    /// a strategy with fewer rays gains by it.
    std::optional<cachesim::Estimate> speed_up, speed_up_per_index;
    std::vector<cachesim::Estimate> counters;  ///< per ray, as MeasureResult::counters
};

struct MeasureReport {
    MeasureResult result;
    std::vector<MeasureRow> rows;       ///< as result.walks, which must not move
    std::vector<std::string> notes;     ///< controls whose interval does not hold 1, ends that differ
    std::vector<std::string> warnings;  ///< those of the notes that a user should not miss
};

MeasureReport make_measure_report(MeasureResult);

/// The rows of one walk side by side over modes: "control (seed 2)" for the control.
std::string row_name(const MeasuredWalk&);

std::string to_text(const MeasureReport&, std::size_t width);
std::string to_json(const MeasureReport&);
std::string to_csv(const MeasureReport&);

}  // namespace raycache::tools
