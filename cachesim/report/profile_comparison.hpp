// Measured beside modelled: the launches of a profile against those of a trace, metric by metric.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "cachesim/report/nsight_csv.hpp"
#include "cachesim/report/profiler.hpp"

namespace raycache::cachesim {

struct ComparedValue {
    std::size_t launch = 0;  ///< of the trace, from 0
    double measured = 0, modelled = 0;
    /// modelled / measured - 1; of percentages modelled - measured, in points. NaN where there is nothing to divide by.
    double difference = 0;
};

struct ComparedMetric {
    const ProfilerMetric* metric = nullptr;
    std::vector<ComparedValue> values;  ///< of each launch that has both
    double mean = 0;                    ///< of the sizes of the differences
    ComparedValue worst;                ///< whose difference is largest

    /// "-3.1 %", "+0.4 points"; "-" where there is none.
    std::string text_of(double difference, bool with_sign) const;
};

struct ComparedLaunch {
    std::string id, kernel;    ///< in the profile
    std::uint32_t sample = 0;  ///< first sample index, in the trace
};

struct ProfileComparison {
    Origin origin;
    std::vector<ComparedLaunch> launches;   ///< that are compared: the first of the trace
    std::vector<ComparedMetric> metrics;    ///< that were measured
    std::vector<std::string> not_measured;  ///< known metrics that the profile lacks
    std::vector<std::string> not_modelled;  ///< metrics of the profile that nothing here is
    std::vector<std::string> notes;
};

/// The first launch of the profile with the first of the series, and so on. Metrics are found by their names, by what
/// the tool's pages call them, and by names of the same number (ProfilerMetric). Throws Error if the profile has more
/// launches than the series or none of the metrics, and as measured_value() does. The series is of no wavefront.
/// `trace`: its name, for messages.
ProfileComparison compare_with_profile(const ProfiledSeries&, const NsightProfile&, const std::string& trace);

std::string to_text(const ProfileComparison&);
/// docs/json.md
std::string to_json(const ProfileComparison&);
/// A line per metric and launch.
std::string to_csv(const ProfileComparison&);

}  // namespace raycache::cachesim
