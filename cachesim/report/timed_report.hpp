// From timed replays to findings: cycles, what binds them, and the predicted speed-up against a baseline.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cachesim/replay/timed/timed_statistics.hpp"
#include "cachesim/report/fidelity.hpp"
#include "cachesim/report/figures/timed_figures.hpp"
#include "cachesim/report/report.hpp"
#include "cachesim/report/verdict.hpp"

namespace raycache::cachesim {

/// All launches of one strategy on one GPU.
struct TimedSeries : Origin {
    std::string no_time;                 ///< no_time_note() of the GPU: only the counts of the launches are to be shown
    std::string traversal = "software";  ///< traversal_name() of the GPU
    std::vector<TimedStatistics> launches;  ///< one per sample index, ascending
    /// Where the speed-up over the baseline was estimated otherwise than from these launches alone
    /// (cachesim/analysis/double_sampling.hpp): that estimate, its interval as wide as it is to be shown.
    std::optional<Estimate> speed_up{};
};

struct TimedRow : TimedSeries {
    TimedStatistics totals;    ///< sums over all launches
    std::string busiest;       ///< the resource that is in use most of the time
    double busiest_share = 0;  ///< of its time
    /// Nothing is in use half of its time: latency is the bottleneck.
    bool waits_most() const { return busiest_share < 0.5; }
    /// Whether cycles, and all that is computed from them, are a prediction.
    bool has_time() const { return no_time.empty(); }
    /// What timed_figures say of the row, but for totals. Absent where they say nothing: what depends on time, where
    /// none is predicted; against a baseline, as in Row.
    std::array<std::optional<Estimate>, std::size(timed_figures)> figures;
    /// row["cycles_per_ray"]
    const std::optional<Estimate>& operator[](TimedKey key) const { return figures[key.index]; }

    std::vector<std::uint32_t> samples() const;
    bool by_rt_unit() const { return traversal != "software"; }
};

struct TimedReport {
    Baseline baseline;
    std::vector<TimedRow> rows;
    /// What the functional replay counts of the same launches, row by row; no rows where none was made.
    Report traffic;
    std::vector<ColdFigures> cold;           ///< as Report has them
    std::optional<FidelityChoice> fidelity;  ///< where a pilot chose the level of accuracy
    std::vector<std::string> notes;

    /// Whether any row's GPU has an L3 that was asked for anything.
    bool has_l3() const;
    /// Whether any row's BVH is walked by RT units.
    bool has_rt_unit() const;
    /// Whether the report shows such a figure, in some row.
    bool shows(Presence) const;
};

/// Which traversal was modelled (traversal_note.hpp).
std::string traversal_note(const TimedReport&);

/// `traffic`: functional replays of the same launches, series by series in the same order, or none. `cold`: launches
/// beside them, likewise, only where there is traffic. Throws UsageError if `baseline` was given by the user but is in no
/// series.
TimedReport make_timed_report(const std::vector<TimedSeries>&, const Baseline& baseline,
                              const std::vector<Series>& traffic = {}, const std::vector<ColdLaunches>& cold = {});

/// What there is to say of a row against its baseline, in time and bytes; none without a ratio.
std::optional<Verdict> verdict_of(const TimedReport&, std::size_t row);

std::string to_text(const TimedReport&, std::size_t width = text_width);
std::string to_json(const TimedReport&);
std::string to_csv(const TimedReport&);

}  // namespace raycache::cachesim
