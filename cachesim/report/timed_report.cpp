#include "cachesim/report/timed_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <tuple>

#include "cachesim/analysis/estimate.hpp"
#include "cachesim/report/pairing.hpp"
#include "cachesim/report/timed_figures.hpp"
#include "traces/error.hpp"

namespace raycache::cachesim {

using namespace figures;

namespace {

TimedStatistics sum_of(const std::vector<TimedStatistics>& launches) {
    TimedStatistics sum;
    for (const TimedStatistics& launch : launches) sum += launch;
    return sum;
}

Sums cycles_over_rays(const TimedSeries& series) {
    Sums sums;
    for (const TimedStatistics& t : series.launches) {
        sums.y.push_back(static_cast<double>(t.cycles));
        sums.x.push_back(static_cast<double>(t.rays));
    }
    return sums;
}
Sums cycles(const TimedSeries& series) {
    Sums sums = cycles_over_rays(series);
    std::fill(sums.x.begin(), sums.x.end(), 1.0);
    return sums;
}

bool comparable(const TimedSeries& a, const TimedSeries& b) {
    const auto key = [](const TimedSeries& s) { return std::tie(s.scene, s.sequence, s.spp, s.gpu); };
    return key(a) == key(b) && same_work_per_launch(a.thread_map, b.thread_map);
}

/// One for each GPU whose time is not predicted.
void note_missing_times(TimedReport& report) {
    for (const TimedRow& row : report.rows)
        if (!row.has_time() &&
            std::find(report.notes.begin(), report.notes.end(), row.series.no_time) == report.notes.end())
            report.notes.push_back(row.series.no_time);
}

/// A note if warps take so few of their slots that cycles say nothing of throughput.
void note_occupancy(TimedReport& report) {
    constexpr double few = 0.5;
    std::vector<std::string> names;
    for (const TimedRow& row : report.rows)
        if (row.has_time() && row.totals.occupancy() < few && row.totals.warps)
            names.push_back(fmt::format("{}, N {}, {}", row.series.strategy, row.series.spp, row.series.gpu));
    if (names.empty()) return;
    const bool all = names.size() == report.rows.size();
    report.notes.push_back(fmt::format(
        "{}: warps take less than half of their slots on average, so cycles are those of the longest warps rather than "
        "throughput; trace more pixels, or model fewer SMs (--set sms=...)",
        all ? std::string("in every row") : fmt::format("{}", fmt::join(names, "; "))));
}

}  // namespace

TimedReport make_timed_report(const std::vector<TimedSeries>& all, const std::string& baseline,
                              const std::vector<Series>& traffic) {
    TimedReport report;
    report.baseline = baseline;
    if (!baseline.empty() &&
        std::none_of(all.begin(), all.end(), [&](const TimedSeries& s) { return s.strategy == baseline; })) {
        std::set<std::string> names;
        for (const TimedSeries& s : all) names.insert(s.strategy);
        throw UsageError(
            fmt::format("baseline: expected one of the strategies {}, found \"{}\"", fmt::join(names, ", "), baseline));
    }
    for (const TimedSeries& series : all) {
        TimedRow row;
        row.series = series;
        row.totals = sum_of(series.launches);
        row.cycles_per_ray = ratio_of_totals(cycles_over_rays(series));
        for (const Named& r : resources) {
            const double share = utilisation(row.totals, row.totals.*r.resource);
            if (share > row.busiest_share) {
                row.busiest_share = share;
                row.busiest = r.name;
            }
        }
        const auto find_base = [&](bool same_map) {
            return std::find_if(all.begin(), all.end(), [&](const TimedSeries& s) {
                return s.strategy == baseline && comparable(s, series) &&
                       (!same_map || s.thread_map == series.thread_map);
            });
        };
        auto base = find_base(true);
        if (base == all.end()) base = find_base(false);
        if (row.has_time() && base != all.end() && series.strategy != baseline) {
            if (samples(*base) == samples(series)) {
                row.speed_up = ratio_to_baseline(cycles(*base), cycles(series));
            } else {
                report.notes.push_back(
                    fmt::format("no speed-up for strategy {}, N {}: its sample indices are not those "
                                "of the baseline {}",
                                series.strategy, series.spp, baseline));
            }
        }
        report.rows.push_back(std::move(row));
    }
    note_occupancy(report);
    note_missing_times(report);
    if (!traffic.empty()) {
        report.traffic = make_report(traffic, baseline, GroupBy::none);
        for (const std::string& note : report.traffic.notes) report.notes.push_back(note);
    }
    return report;
}

std::optional<Verdict> verdict_of(const TimedReport& report, std::size_t row) {
    Difference d;
    if (!report.traffic.rows.empty()) d = difference_of(report.traffic.rows[row]);
    const TimedRow& timed = report.rows[row];
    d.speed_up = timed.speed_up;
    d.traced = timed.series.launches.size();
    d.spp = timed.series.spp;
    if (!d.speed_up && !d.dram_bytes) return std::nullopt;
    return verdict(d);
}

}  // namespace raycache::cachesim
