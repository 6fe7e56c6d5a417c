#include "cachesim/report/timed_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string_view>
#include <tuple>

#include "cachesim/report/estimate.hpp"
#include "cachesim/report/pairing.hpp"
#include "cachesim/report/table.hpp"
#include "cachesim/report/timed_figures.hpp"
#include "traces/error.hpp"
#include "traces/printable.hpp"

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

std::string decimals(double value, int digits) {
    return std::isfinite(value) ? fmt::format("{:.{}f}", value, digits) : "-";
}
std::string percent(double share) { return decimals(100 * share, 1); }
std::string with_interval(const std::optional<Estimate>& e, int digits) {
    if (!e) return "-";
    return decimals(e->mean, digits) + (e->half_width ? " ±" + decimals(*e->half_width, digits) : "");
}

/// "DRAM (81.2 %)", "latency; busiest: L1 port (31.0 %)".
std::string bottleneck(const TimedRow& row) {
    if (!row.has_time()) return "-";
    return fmt::format("{}{} ({} %)", row.waits_most() ? "latency; busiest: " : "", row.busiest,
                       percent(row.busiest_share));
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

TimedReport make_timed_report(const std::vector<TimedSeries>& all, const std::string& baseline) {
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
    return report;
}

std::string to_text(const TimedReport& report) {
    using Align = TextTable::Align;
    const bool three = std::any_of(report.rows.begin(), report.rows.end(),
                                   [](const TimedRow& row) { return row.totals.l3.requests() > 0; });
    const bool one_gpu =
        !report.rows.empty() && std::all_of(report.rows.begin(), report.rows.end(), [&](const TimedRow& row) {
            return row.series.gpu == report.rows.front().series.gpu;
        });
    TextTable times, hits, use, rates;
    for (TextTable* table : {&times, &hits, &use, &rates}) {
        table->column("strategy", Align::left);
        table->column("N", Align::right);
        if (!one_gpu) table->column("GPU", Align::left);
    }
    for (const char* title : {"cycles", "ms", "cycles/ray", "speed-up", "occupancy %"})
        times.column(title, Align::right);
    times.column("bottleneck", Align::left);
    for (const char* level : {"L1", "L2", "L3"}) {
        if (!three && std::string_view(level) == "L3") break;
        hits.column(fmt::format("{} hit %", level), Align::right);
        hits.column("(merges miss)", Align::right);
    }
    hits.column("DRAM sectors", Align::right);
    for (const Named& r : resources) use.column(fmt::format("{} %", r.name), Align::right);
    for (const Named& r : parts) use.column(fmt::format("{} %", r.name), Align::right);
    for (const char* title : {"L2 GB/s", "peak", "DRAM GB/s", "peak", "visit latency"})
        rates.column(title, Align::right);
    for (const TimedRow& row : report.rows) {
        const TimedStatistics& t = row.totals;
        std::vector<std::string> identity{row.series.strategy, fmt::format("{}", row.series.spp)};
        if (!one_gpu) identity.push_back(row.series.gpu);
        const auto add = [&](TextTable& table, std::vector<std::string> cells) {
            cells.insert(cells.begin(), identity.begin(), identity.end());
            table.row(cells);
        };
        const bool time = row.has_time();
        add(times, {time ? fmt::format("{}", t.cycles) : "-", decimals(in_time(row, 1e3 * t.seconds), 3),
                    time ? with_interval(row.cycles_per_ray, 2) : "-",
                    time && row.series.strategy == report.baseline ? "1" : with_interval(row.speed_up, 3),
                    percent(occupancy(row)), bottleneck(row)});
        std::vector<std::string> cells;
        for (const LevelAnswers* level : {&t.l1, &t.l2, &t.l3}) {
            if (!three && level == &t.l3) break;
            cells.push_back(percent(hit_rate(*level, true)));
            cells.push_back(percent(hit_rate(*level, false)));
        }
        cells.push_back(fmt::format("{}", t.dram_sectors));
        add(hits, cells);
        cells.clear();
        for (const Named& r : resources) cells.push_back(percent(utilisation(row, r)));
        for (const Named& r : parts) cells.push_back(percent(utilisation(row, r)));
        add(use, cells);
        add(rates, {decimals(l2_gb_s(row), 1), decimals(t.peak_l2_gb_s, 0), decimals(dram_gb_s(row), 1),
                    decimals(t.peak_dram_gb_s, 0), decimals(visit_latency(row), 0)});
    }
    std::string text = one_gpu ? "GPU: " + report.rows.front().series.gpu + "\n\n" : "";
    text += times.text() + "\n" + hits.text() + "\n" + use.text() + "\n" + rates.text() + "\n";
    text +=
        "speed-up: cycles of " + (report.baseline.empty() ? std::string("a baseline") : report.baseline) +
        " over those of the row. occupancy: share of the slots for warps that is taken, on\n"
        "average. hit %: of sector requests, one for each load instruction and sector; a request for a sector on its "
        "way\n"
        "counts as a hit, or in the column \"merges miss\" as none. % of a resource: of its time; L1 tags and L1 data "
        "are\nwhat the L1 port does, MSHRs registers for sectors on their way. L2 slices, L2 GB/s: of the level that "
        "all SMs "
        "share.\n"
        "visit latency: cycles from the first load of a visit to its last data.\n";
    for (const std::string& note : report.notes) text += "note: " + printable_line(note) + "\n";
    return text;
}

}  // namespace raycache::cachesim
