#include "cachesim/report/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "cachesim/analysis/estimate.hpp"
#include "cachesim/report/cold_launches.hpp"
#include "cachesim/report/groups.hpp"
#include "cachesim/report/verdict.hpp"
#include "cachesim/report/window_notes.hpp"

namespace raycache::cachesim {

namespace {

/// Whether the figure says anything of such a row.
bool concerns(const TrafficFigure& figure, const Row& row) {
    if (figure.of_cold_launch && row.windows) return false;
    switch (figure.presence) {
        case Presence::three_levels:
            return row.caches.levels == 3;
        case Presence::wavefront:
            return row.totals.written_sectors != 0 || row.totals.sort_sectors != 0;
        default:
            return true;
    }
}

Row make_row(const Series& series, const LaunchGroup& group) {
    Row row{static_cast<const Origin&>(series), group.name, {}, group.by_launch, {}, group.loads, group.stores, {}, {}};
    for (const LaunchStatistics& launch : series.launches) row.samples.push_back(launch.sample);
    for (const Counters& c : row.by_launch) row.totals += c;
    for (std::size_t i = 0; i < row.figures.size(); ++i) {
        const TrafficFigure& figure = traffic_figures[i];
        if (!concerns(figure, row)) continue;
        if (figure.of == Of::mean) row.figures[i] = ratio_of_totals(sums_of(figure, row.by_launch, row.caches));
        if (figure.of == Of::quotient) row.figures[i] = Estimate{figure.value(row.totals, row.caches), {}};
    }
    return row;
}

std::string name_of(const Row& row) {
    return fmt::format("scene {}, sequence {}, N {}, thread map {}, GPU {}", row.scene, row.sequence, row.spp,
                       row.thread_map, row.gpu);
}

/// Notes in order of first mention, each once.
class Notes {
public:
    explicit Notes(std::vector<std::string>& notes) : notes_(notes) {}
    void add(const std::string& note) {
        if (seen_.insert(note).second) notes_.push_back(note);
    }

private:
    std::vector<std::string>& notes_;
    std::set<std::string> seen_;
};

void compare(Row& row, const std::vector<Row>& rows, const Baseline& baseline, Notes& notes) {
    const Row* const base =
        find_baseline(rows, row, baseline, [&](const Row& other) { return other.group == row.group; });
    if (!base) {
        notes.add(fmt::format("no ratio to the baseline {0} for {1}: the baseline has no such row{2}", baseline.name(),
                              name_of(row), row.group == "all" ? "" : " in group " + row.group));
        return;
    }
    if (base->samples != row.samples) {
        notes.add(
            fmt::format("no ratio to the baseline {} for strategy {}, {}: their sample indices differ, so they "
                        "cannot be paired",
                        baseline.name(), row.strategy, name_of(row)));
        return;
    }
    if (base->caches.levels != row.caches.levels || base->caches.sector_bytes != row.caches.sector_bytes) {
        notes.add(fmt::format("no ratio to the baseline {} for {}: its caches have other levels or sectors",
                              baseline.name(), name_of(row)));
        return;
    }
    row.factors = traffic_factors(base->by_launch, row.by_launch, row.caches);
    for (std::size_t i = 0; i < row.figures.size(); ++i) {
        const TrafficFigure& figure = traffic_figures[i];
        if (figure.of == Of::ratio && concerns(figure, row) && (row.factors || !figure.of_factors))
            row.figures[i] = ratio_of(figure, base->by_launch, row.by_launch, row.caches);
    }
}

void widen(Row& row) {
    if (!row.windows) return;
    for (auto& figure : row.figures)
        if (figure) figure = with_interval_of(*row.windows, *figure);
    if (row.factors) row.factors->widen(row.windows->widening);
}

void note_compulsory(const Report& report, Notes& notes) {
    std::vector<std::string> gpus;
    for (const Row& row : report.rows)
        if (difference_of(row).dram_compulsory_share >= mostly_compulsory &&
            std::find(gpus.begin(), gpus.end(), row.gpu) == gpus.end())
            gpus.push_back(row.gpu);
    if (!gpus.empty()) notes.add(compulsory_note(fmt::format("{}", fmt::join(gpus, ", "))));
}

}  // namespace

bool Report::has_l3() const {
    return std::any_of(rows.begin(), rows.end(), [](const Row& row) { return row.caches.levels == 3; });
}

bool Report::has_wavefront() const {
    return std::any_of(rows.begin(), rows.end(),
                       [](const Row& row) { return row["written_bytes_per_ray"].has_value(); });
}

bool Report::has(Presence presence) const {
    return presence == Presence::always || (presence == Presence::three_levels ? has_l3() : has_wavefront());
}

std::string row_label(const Report& report, const Row& row) {
    std::string label = row.strategy;
    const auto differs = [&](std::string Origin::*what) {
        return std::any_of(report.rows.begin(), report.rows.end(), [&](const Row& other) {
            return other.strategy == row.strategy && other.spp == row.spp && other.gpu == row.gpu &&
                   other.group == row.group && other.*what != row.*what;
        });
    };
    for (std::string Origin::*what : {&Origin::parameters, &Origin::sequence, &Origin::thread_map, &Origin::scene})
        if (differs(what)) label += ", " + row.*what;
    return fmt::format("{}, N {}, {}{}", label, row.spp, row.gpu, report.by == GroupBy::none ? "" : ", " + row.group);
}

Report make_report(const std::vector<Series>& all_series, const Baseline& baseline, GroupBy by,
                   const std::vector<ColdLaunches>& cold) {
    Report report;
    report.baseline = baseline;
    report.by = by;
    check_baseline(all_series, baseline);
    for (const Series& series : all_series)
        for (const LaunchGroup& group : split(series.launches, by)) report.rows.push_back(make_row(series, group));

    Notes notes(report.notes);
    for (Row& row : report.rows) {
        if (!baseline.empty() && !baseline.is(row)) compare(row, report.rows, baseline, notes);
        widen(row);
        if (row.samples.size() == 1 && !(row.windows && row.windows->all_indices))
            notes.add(row.indices == 1
                          ? std::string("one sample index: no confidence interval")
                          : fmt::format("one launch of {} sample indices: no confidence interval", row.indices));
    }
    note_windows(report.rows, [&](const std::string& note) { notes.add(note); });
    note_compulsory(report, notes);
    report.cold = cold_figures(cold, all_series, {}, baseline);
    return report;
}

}  // namespace raycache::cachesim
