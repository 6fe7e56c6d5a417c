// From counts to findings: one row per strategy x N x GPU (x group), means over sample indices with 95 % confidence
// intervals, ratios to a baseline paired by sample index, and the exact split of the traffic ratio into factors.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cachesim/analysis/estimate.hpp"
#include "cachesim/analysis/factor_terms.hpp"
#include "cachesim/replay/statistics.hpp"
#include "cachesim/report/table.hpp"

namespace raycache::cachesim {

/// All launches of one strategy on one GPU.
struct Series {
    std::string scene, strategy, sequence, parameters, thread_map, gpu;
    std::uint64_t spp = 0;
    std::uint32_t sector_bytes = 32;         ///< of the GPU's caches: turns sectors into bytes
    std::size_t levels = 2;                  ///< of the GPU's caches: 2 or 3
    std::vector<LaunchStatistics> launches;  ///< one per sample index, ascending
};

enum class GroupBy { none, bounce, ray, object };  ///< ray: camera, bounce, shadow; object: node, triangle, texel

struct Row {
    std::string scene, strategy, sequence, parameters, thread_map, gpu,
        group;  ///< group: "all", "bounce 1", "shadow 0", "node"
    std::uint64_t spp = 0;
    std::uint32_t sector_bytes = 32;
    std::size_t levels = 2;
    std::vector<std::uint32_t> samples;
    Counters totals;         ///< over all sample indices; in groups by object, `rays` are those of the whole launch
    Counters loads, stores;  ///< of totals: what reads and what writes; sorts are neither
    /// l1_hit_rate: of requests, as Nsight Compute counts (l1tex__t_sector_hit_rate): every load of a visit asks for
    /// its sectors, so most requests hit what an earlier load fetched (LoadCounter).
    Estimate rays, steps_per_ray, active_lanes, sectors_per_access, l1_hit_rate, l2_hit_rate, l2_bytes_per_ray,
        dram_bytes_per_ray;
    /// Of visits: of the distinct sectors of each warp access, those found in L1. As many misses, fewer hits; 1 minus
    /// it is the L1 miss rate of the traffic identity.
    Estimate l1_visit_hit_rate;
    /// Of the sectors read from DRAM, those that no cache of the GPU held before: compulsory misses, which come of
    /// beginning each launch with cold caches.
    Estimate dram_compulsory_share;
    std::optional<Estimate> l3_hit_rate, l3_bytes_per_ray;  ///< bytes that L2 asks of L3; absent where there is no L3
    /// Of dram_bytes_per_ray: what kernels write, and what sorts move. Absent where no trace is of a wavefront.
    std::optional<Estimate> written_bytes_per_ray, sort_bytes_per_ray;
    /// Against the baseline row of the same scene, sequence, N, thread map, GPU and group; absent for the baseline
    /// itself or where there is none or its sample indices differ (a note says so).
    std::optional<Estimate> l2_bytes_ratio, l3_bytes_ratio, dram_bytes_ratio;  ///< l3: absent where there is no L3
    std::optional<Factors> factors;
};

struct Report {
    std::string baseline;
    GroupBy by = GroupBy::none;
    std::vector<Row> rows;
    std::vector<std::string> notes;  ///< such as "no baseline row for …", "one sample index: no confidence interval"

    /// Whether any row's GPU has an L3: only then do tables show what concerns it.
    bool has_l3() const;
    /// Likewise, whether any row writes to DRAM or sorts.
    bool has_wavefront() const;
};

/// What a sentence calls a row: "micro-jitter, N 64, gtx-980-ti", and what else tells it from others.
std::string row_label(const Report&, const Row&);

/// Throws UsageError if `baseline` was given by the user but is in no series.
Report make_report(const std::vector<Series>&, const std::string& baseline, GroupBy);

/// Tables of at most `width` columns where they can be so narrow: TextTable.
std::string to_text(const Report&, std::size_t width = text_width);
/// The table of factors alone, with a title and a legend; nothing where no row has any.
std::string factor_table(const Report&, std::size_t width);
std::string to_json(const Report&);
std::string to_csv(const Report&);

}  // namespace raycache::cachesim
