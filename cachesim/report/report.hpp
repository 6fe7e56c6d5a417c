// From counts to findings: one row per strategy x N x GPU (x group), means over sample indices with 95 % confidence
// intervals, ratios to a baseline paired by sample index, and the exact split of the traffic ratio into factors.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cachesim/analysis/estimate.hpp"
#include "cachesim/analysis/traffic_identity.hpp"
#include "cachesim/replay/statistics.hpp"
#include "cachesim/report/cold_figures.hpp"
#include "cachesim/report/figures/traffic_figures.hpp"
#include "cachesim/report/origin.hpp"
#include "cachesim/report/table.hpp"

namespace raycache::cachesim {

/// All launches of one strategy on one GPU.
struct Series : Origin {
    std::vector<LaunchStatistics> launches;  ///< one per sample index, ascending
};

enum class GroupBy { none, bounce, ray, object };  ///< ray: camera, bounce, shadow; object: node, triangle, texel

struct Row : Origin {
    std::string group;  ///< "all", "bounce 1", "shadow 0", "node"
    std::vector<std::uint32_t> samples;
    std::vector<Counters> by_launch;  ///< one per sample index; in groups by object, `rays` are those of the launch
    Counters totals;                  ///< of these
    Counters loads, stores;           ///< of totals: what reads and what writes; sorts are neither

    /// What traffic_figures say of the row, but for totals. Absent where they say nothing: figures of an L3 where there
    /// is none; of a wavefront where no trace is of one; against a baseline, for the baseline itself and where there is
    /// none of the same scene, sequence, N, thread map, GPU and group, or its sample indices differ (a note says so).
    std::array<std::optional<Estimate>, std::size(traffic_figures)> figures;
    /// row["dram_bytes_ratio"]
    const std::optional<Estimate>& operator[](TrafficKey key) const { return figures[key.index]; }
    /// Against the baseline; absent where a factor has no value, too.
    std::optional<Factors> factors;
};

struct Report {
    Baseline baseline;
    GroupBy by = GroupBy::none;
    std::vector<Row> rows;
    std::vector<ColdFigures> cold;   ///< row by row; none unless launches from cold caches were asked for
    std::vector<std::string> notes;  ///< such as "no baseline row for …", "one sample index: no confidence interval"

    /// Whether any row's GPU has an L3: only then do tables show what concerns it.
    bool has_l3() const;
    /// Likewise, whether any row writes to DRAM or sorts.
    bool has_wavefront() const;
    bool has(Presence) const;
    /// Whether rows are estimates from windows: all are, or none.
    bool has_windows() const { return !rows.empty() && rows.front().windows.has_value(); }
};

/// What a sentence calls a row: "micro-jitter, N 64, gtx-980-ti", and what else tells it from others.
std::string row_label(const Report&, const Row&);

/// Throws UsageError if `baseline` was given by the user but is in no series. `cold`: of each series, in the same order,
/// or none; only of whole launches (GroupBy::none).
Report make_report(const std::vector<Series>&, const Baseline& baseline, GroupBy,
                   const std::vector<ColdLaunches>& cold = {});

/// Tables of at most `width` columns where they can be so narrow: TextTable.
std::string to_text(const Report&, std::size_t width = text_width);
/// The table of factors alone, with a title and a legend; nothing where no row has any.
std::string factor_table(const Report&, std::size_t width);
std::string to_json(const Report&);
std::string to_csv(const Report&);

}  // namespace raycache::cachesim
