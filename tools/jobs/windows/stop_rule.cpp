#include "tools/jobs/windows/stop_rule.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "cachesim/report/verdict.hpp"
#include "tools/jobs/baseline.hpp"

namespace raycache::tools {
namespace {

void take(Worst& worst, const cachesim::Estimate& e, const std::string& what) {
    const double relative = !e.half_width        ? std::numeric_limits<double>::infinity()
                            : *e.half_width == 0 ? 0  // of a mean of 0, too
                                                 : *e.half_width / std::fabs(e.mean);
    if (std::isfinite(e.mean) && !(relative <= worst.error)) worst = {relative, what};
}

/// What level number `level` fetches, over what L1 is asked for.
double share_of_asked(const cachesim::Row& row, std::size_t level) {
    const auto asked = static_cast<double>(row.totals.levels[0].sectors);
    return asked == 0 ? 0 : static_cast<double>(row.totals.fetched(level, row.caches.levels)) / asked;
}

Worst worst_of(const std::vector<cachesim::Series>& all, const cachesim::Baseline& baseline) {
    Worst worst;
    const cachesim::Report report = cachesim::make_report(all, baseline, cachesim::GroupBy::none);
    const bool compared = std::any_of(report.rows.begin(), report.rows.end(),
                                      [](const cachesim::Row& row) { return row["l2_bytes_ratio"].has_value(); });
    for (const cachesim::Row& row : report.rows) {
        const auto figures = cachesim::bytes_figures(row.caches.levels);
        for (std::size_t level = 0; level < figures.size(); ++level) {
            if (level + 1 == figures.size() && !row.windows->last_cache_full) continue;  // nothing steady to estimate
            const cachesim::Row* const base = cachesim::find_baseline(
                report.rows, row, baseline, [&](const cachesim::Row& other) { return other.group == row.group; });
            if (std::max(share_of_asked(row, level), base ? share_of_asked(*base, level) : 0) < negligible_share)
                continue;
            const cachesim::TrafficKey key = compared ? figures[level].ratio : figures[level].mean;
            if (row[key])
                take(worst, *row[key],
                     fmt::format("{} of {}", cachesim::traffic_figures[key.index].title,
                                 cachesim::row_label(report, row)));
        }
    }
    return worst;
}

Worst worst_of(const std::vector<cachesim::TimedSeries>& all, const cachesim::Baseline& baseline) {
    Worst worst;
    const cachesim::TimedReport report = cachesim::make_timed_report(all, baseline);
    const bool compared = std::any_of(report.rows.begin(), report.rows.end(),
                                      [](const cachesim::TimedRow& row) { return row["speed_up"].has_value(); });
    for (const cachesim::TimedRow& row : report.rows) {
        const cachesim::TimedKey key = compared ? cachesim::TimedKey("speed_up") : cachesim::TimedKey("cycles_per_ray");
        if (row[key])
            take(worst, *row[key],
                 fmt::format("{} of {}, N {}, {}", cachesim::timed_figures[key.index].title, row.strategy, row.spp,
                             row.gpu));
    }
    return worst;
}

}  // namespace

Worst worst_error(const Predicted& now, const std::string& baseline, bool across_gpus) {
    return now.times.empty() ? worst_of(now.traffic, baseline_of(now.traffic, baseline, across_gpus))
                             : worst_of(now.times, baseline_of(now.times, baseline, across_gpus));
}

}  // namespace raycache::tools
