// Reads what `ncu --csv` prints: the measured side of a comparison.
//
// Two forms (Nsight Compute CLI guide, --csv and --page): long, a metric of a launch a line, with the columns "Metric
// Name", "Metric Unit" and "Metric Value"; and wide (--page raw), a launch a line, a metric a column, the units in a
// line of their own below the titles. Lines before the titles, and those that begin with "==", are the tool's and the
// program's messages.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace raycache::cachesim {

struct MeasuredMetric {
    std::string name;         ///< as printed: "dram__bytes_read.sum", or a label: "L2 Hit Rate"
    std::string unit, value;  ///< as printed: "Kbyte", "1,234.5", "n/a"
    std::size_t line = 0;     ///< of the file
};

struct MeasuredLaunch {
    std::string id, process, kernel;
    std::vector<MeasuredMetric> metrics;
};

struct NsightProfile {
    std::string file;  ///< for messages
    std::vector<MeasuredLaunch> launches;
};

/// `file`: its name, for messages. Throws Error, in one line, for what is no such table: empty, binary, of another
/// tool, a quote that is not closed, a line of too few or too many fields, no launch.
NsightProfile read_nsight_csv(std::string_view text, const std::string& file);

/// The value in units of `unit` ("byte", "nsecond", "byte/second", "sector"): without separators of thousands, scaled
/// units (Kbyte: 1000 bytes) taken out. NaN where the tool has no value ("n/a"). Throws Error for what is no number,
/// and for a unit of which it does not know how many of `unit` it is.
double measured_value(const MeasuredMetric&, std::string_view unit, const std::string& file);

}  // namespace raycache::cachesim
