// What the tables and files of a timed report show of a row, computed from its counts.
#pragma once

#include <cmath>

#include "cachesim/report/timed_report.hpp"

namespace raycache::cachesim::figures {

struct Named {
    const char* name;
    TimedStatistics::Resource TimedStatistics::*resource;
};
/// What may bind a launch.
inline constexpr Named resources[] = {{"issue", &TimedStatistics::issue},
                                      {"L1 port", &TimedStatistics::l1_port},
                                      {"crossbar", &TimedStatistics::crossbar},
                                      {"L2 slices", &TimedStatistics::l2_slices},
                                      {"DRAM", &TimedStatistics::dram}};
/// Parts of these, and the registers for misses.
inline constexpr Named parts[] = {{"L1 tags", &TimedStatistics::l1_tags},
                                  {"L1 data", &TimedStatistics::l1_data},
                                  {"L1 MSHRs", &TimedStatistics::l1_mshrs},
                                  {"L2 MSHRs", &TimedStatistics::l2_mshrs}};

/// The level that all SMs share.
inline const LevelAnswers& shared_level(const TimedStatistics& t) { return t.l3.requests() ? t.l3 : t.l2; }

inline double ratio(double a, double b) { return b == 0 ? std::nan("") : a / b; }

inline double utilisation(const TimedStatistics& t, TimedStatistics::Resource r) {
    return ratio(r.busy, static_cast<double>(r.copies) * static_cast<double>(t.cycles));
}

/// What depends on time: not a number where the row has none.
inline double in_time(const TimedRow& row, double value) { return row.has_time() ? value : std::nan(""); }
inline double utilisation(const TimedRow& row, const Named& r) {
    return in_time(row, utilisation(row.totals, row.totals.*r.resource));
}
inline double occupancy(const TimedRow& row) { return in_time(row, row.totals.occupancy()); }

inline double hit_rate(const LevelAnswers& a, bool merges_hit) {
    return ratio(static_cast<double>(a.hits + (merges_hit ? a.merges : 0)), static_cast<double>(a.requests()));
}

inline double gigabytes_per_second(const TimedRow& row, std::uint64_t sectors) {
    return in_time(row, ratio(static_cast<double>(sectors) * row.series.sector_bytes / 1e9, row.totals.seconds));
}
inline double l2_gb_s(const TimedRow& row) { return gigabytes_per_second(row, shared_level(row.totals).requests()); }
inline double dram_gb_s(const TimedRow& row) { return gigabytes_per_second(row, row.totals.dram_sectors); }
inline double visit_latency(const TimedRow& row) {
    return in_time(row,
                   ratio(static_cast<double>(row.totals.visit_cycles), static_cast<double>(row.totals.warp_accesses)));
}

inline std::vector<std::uint32_t> samples(const TimedSeries& s) {
    std::vector<std::uint32_t> all;
    for (const TimedStatistics& t : s.launches) all.push_back(t.sample);
    return all;
}

}  // namespace raycache::cachesim::figures
