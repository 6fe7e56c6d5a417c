// The metrics of Nsight Compute that a replay has a number for: name, unit, formula. docs/counters.md has the table.
//
// Names and units are those of NVIDIA's documentation (Nsight Compute, Kernel Profiling Guide, "Metrics Decoder" and
// "Memory Tables"; CLI guide, table of nvprof's metrics) and of the section and rule files that come with the tool. A
// rate is over the time that the timed replay predicts, a percentage of a peak is of the peak that the GPU file says.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <variant>

#include "cachesim/analysis/counts.hpp"
#include "cachesim/replay/statistics.hpp"
#include "cachesim/replay/timed/timed_statistics.hpp"

namespace raycache::cachesim {

/// What the metrics of a row of a report, or of a launch, are computed from.
struct ProfileCounts {
    Counters loads, stores, totals;  ///< what reads, what writes, all that moves: sorts are in none of the first two
    /// The same loads and stores, as L2RequestCounter::in_instructions() counts them.
    Counters load_instructions, store_instructions;
    CacheUnits caches;
    std::optional<TimedStatistics> time;  ///< none: no time was predicted
};

/// A count, or a number: NaN where nothing was counted.
using MetricValue = std::variant<std::uint64_t, double>;
double number_of(const MetricValue&);

/// What a metric needs to be there at all.
enum class MetricNeed {
    nothing,
    stores,     ///< a trace of a wavefront
    no_stores,  ///< none: it mixes reads and writes, and the model does not know of all writes whether they hit
    time,       ///< a timed replay
    read_time,  ///< a timed replay of a trace without stores
};

struct ProfilerMetric {
    const char* name;     ///< "dram__bytes_read.sum"
    const char* unit;     ///< "byte", "sector", "request", "%", "byte/second", "nsecond", …; "" for plain numbers
    const char* formula;  ///< in the names of counts of docs/figures.md and docs/json.md
    MetricNeed need;
    MetricValue (*of)(const ProfileCounts&);
    /// What `ncu --page details` calls it, where that is one metric only; null: nothing.
    const char* label = nullptr;
    /// Other metrics of Nsight Compute that are the same number of a kernel that only loads; separated by blanks.
    const char* same_of_loads = "";

    bool is_percentage() const;
    /// A quotient: rounded, and of no scaled unit.
    bool is_quotient() const;
};

/// In the order of tables: reads from L1 down, instructions, stores, then what needs time.
std::span<const ProfilerMetric> profiler_metrics();

}  // namespace raycache::cachesim
