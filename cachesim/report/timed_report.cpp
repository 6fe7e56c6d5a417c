#include "cachesim/report/timed_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "cachesim/analysis/estimate.hpp"
#include "cachesim/report/cold_launches.hpp"
#include "cachesim/report/traversal_note.hpp"
#include "cachesim/report/window_notes.hpp"

namespace raycache::cachesim {

namespace {

TimedStatistics sum_of(const std::vector<TimedStatistics>& launches) {
    TimedStatistics sum;
    for (const TimedStatistics& launch : launches) sum += launch;
    return sum;
}

Sums sums(const TimedFigure& figure, const TimedSeries& series) {
    Sums sums;
    for (const TimedStatistics& t : series.launches) {
        sums.y.push_back(figure.numerator(t, series.caches));
        sums.x.push_back(figure.denominator ? (*figure.denominator)(t, series.caches) : 1.0);
    }
    return sums;
}

std::vector<std::uint32_t> samples_of(const TimedSeries& series) {
    std::vector<std::uint32_t> all;
    for (const TimedStatistics& t : series.launches) all.push_back(t.sample);
    return all;
}

TimedRow make_row(const TimedSeries& series) {
    TimedRow row{series, sum_of(series.launches), {}, 0, {}};
    for (std::size_t i = 0; i < row.figures.size(); ++i) {
        const TimedFigure& figure = timed_figures[i];
        const double value = figure.value(row.totals, row.caches);
        if (figure.table == Table::use && figure.rank == 0 && value > row.busiest_share) {
            row.busiest_share = value;
            row.busiest = figure.title;
        }
        if (figure.in_time && !row.has_time()) continue;
        if (figure.of == Of::mean) row.figures[i] = ratio_of_totals(sums(figure, series));
        if (figure.of == Of::quotient) row.figures[i] = Estimate{value, {}};
    }
    return row;
}

/// One for each GPU whose time is not predicted.
void note_missing_times(TimedReport& report) {
    for (const TimedRow& row : report.rows)
        if (!row.has_time() && std::find(report.notes.begin(), report.notes.end(), row.no_time) == report.notes.end())
            report.notes.push_back(row.no_time);
}

/// A note if warps take so few of their slots that cycles say nothing of throughput.
void note_occupancy(TimedReport& report) {
    constexpr double few = 0.5;
    std::vector<std::string> names;
    for (const TimedRow& row : report.rows)
        if (row.has_time() && row.totals.occupancy() < few && row.totals.warps)
            names.push_back(fmt::format("{}, N {}, {}", row.strategy, row.spp, row.gpu));
    if (names.empty()) return;
    const bool all = names.size() == report.rows.size();
    report.notes.push_back(fmt::format(
        "{}: warps take less than half of their slots on average, so cycles are those of the longest warps rather than "
        "throughput; trace more pixels, or model fewer SMs (--set sms=...)",
        all ? std::string("in every row") : fmt::format("{}", fmt::join(names, "; "))));
}

}  // namespace

TimedReport make_timed_report(const std::vector<TimedSeries>& all, const Baseline& baseline,
                              const std::vector<Series>& traffic, const std::vector<ColdLaunches>& cold) {
    TimedReport report;
    report.baseline = baseline;
    check_baseline(all, baseline);
    for (const TimedSeries& series : all) {
        TimedRow row = make_row(series);
        const TimedSeries* const base = find_baseline(all, series, baseline, [](const TimedSeries&) { return true; });
        if (row.has_time() && base && !baseline.is(series)) {
            if (samples_of(*base) == samples_of(series)) {
                for (std::size_t i = 0; i < row.figures.size(); ++i)
                    if (const TimedFigure& figure = timed_figures[i]; figure.of == Of::gain)
                        row.figures[i] = ratio_to_baseline(sums(figure, *base), sums(figure, series));
            } else {
                report.notes.push_back(
                    fmt::format("no speed-up for strategy {}, N {}: its sample indices are not those "
                                "of the baseline {}",
                                series.strategy, series.spp, baseline.name()));
            }
        }
        if (row.windows)
            for (auto& figure : row.figures)
                if (figure) figure = with_interval_of(*row.windows, *figure);
        if (series.speed_up) row.figures[TimedKey("speed_up").index] = series.speed_up;
        report.rows.push_back(std::move(row));
    }
    note_occupancy(report);
    note_missing_times(report);
    if (!traffic.empty()) {
        report.cold = cold_figures(cold, traffic, all, baseline);
        report.traffic = make_report(traffic, baseline, GroupBy::none);
        for (const std::string& note : report.traffic.notes) report.notes.push_back(note);
    } else {
        note_windows(report.rows, [&](const std::string& note) { report.notes.push_back(note); });
    }
    return report;
}

std::vector<std::uint32_t> TimedRow::samples() const { return samples_of(*this); }

bool TimedReport::has_l3() const {
    return std::any_of(rows.begin(), rows.end(),
                       [](const TimedRow& row) { return row.totals.levels[2].requests() > 0; });
}

bool TimedReport::has_rt_unit() const {
    return std::any_of(rows.begin(), rows.end(), [](const TimedRow& row) { return row.by_rt_unit(); });
}

bool TimedReport::shows(Presence presence) const {
    switch (presence) {
        case Presence::three_levels:
            return has_l3();
        case Presence::rt_unit:
            return has_rt_unit();
        default:
            return presence == Presence::always;
    }
}

std::string traversal_note(const TimedReport& report) {
    std::vector<std::string> units;
    bool software = false;
    for (const TimedRow& row : report.rows) {
        if (!row.by_rt_unit())
            software = true;
        else if (std::find(units.begin(), units.end(), row.gpu) == units.end())
            units.push_back(row.gpu);
    }
    return traversal_note(units, software);
}

std::optional<Verdict> verdict_of(const TimedReport& report, std::size_t row) {
    Difference d;
    if (!report.traffic.rows.empty()) d = difference_of(report.traffic.rows[row]);
    const TimedRow& timed = report.rows[row];
    d.speed_up = timed["speed_up"];
    d.windows = timed.windows;
    d.traced = timed.launches.size();
    d.spp = timed.spp;
    if (!d.speed_up && d.bytes.empty()) return std::nullopt;
    return verdict(d);
}

}  // namespace raycache::cachesim
