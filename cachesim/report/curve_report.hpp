// Cache curves as a report: hit rates and bytes per ray by size of a level's caches, and what size and bandwidth one
// strategy would need to do as well as another.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "cachesim/analysis/cache_curve.hpp"
#include "cachesim/report/origin.hpp"
#include "cachesim/report/table.hpp"

namespace raycache::cachesim {

/// One strategy on one GPU.
struct CurveSeries : Origin {
    std::vector<std::uint32_t> samples;  ///< first sample index of each launch
    std::vector<LevelCurve> levels;      ///< those asked for, from L1 down
    std::uint64_t memory_bytes = 0;      ///< most that the curves of a launch took while it was replayed
};

/// What `base` needs to do as well as `other` with the GPU's own cache.
struct Equivalent {
    std::string base, other;            ///< strategies
    std::string base_name, other_name;  ///< in sentences: series_name()
    std::uint64_t spp = 0;              ///< N
    std::size_t level = 0;              ///< 0: L1
    std::size_t levels = 2;             ///< of the GPU
    EquivalentSize bytes, misses;       ///< as few bytes per ray; as few misses
    Estimate bandwidth;                 ///< with the GPU's own cache for both
};

struct CurveReport {
    std::string baseline;  ///< whose equivalent sizes are found; empty: of none
    std::vector<CurveSeries> series;
    std::vector<std::uint64_t> sizes;  ///< bytes of a cache, ascending; empty: as table_sizes() says
    std::vector<Equivalent> equivalents;
    std::vector<std::string> notes;
};

/// `sizes`: those of the table, each a whole number of ways of the GPU's own sets. Throws UsageError for a baseline
/// that is no series.
CurveReport make_curve_report(std::vector<CurveSeries>, const std::string& baseline, std::vector<std::uint64_t> sizes);

/// The rows of a level's table: the sizes asked for, else own size times powers of two, up to the first that leaves
/// nothing to gain.
std::vector<std::uint64_t> table_sizes(const CurveReport&, std::size_t level);
/// About eight sizes an octave, from one way to the first that leaves nothing to gain: enough to draw a curve.
std::vector<std::uint64_t> drawn_ways(const CurveRow&);

/// What tells a series from the others of the report: its strategy, and sequence, N or parameters where it must be.
std::string series_name(const CurveReport&, const CurveSeries&);
/// "L1: micro-jitter with 128 KiB fetches as few bytes per ray as cranley-patterson with 600 KiB (4.7x; …); …"
std::string to_sentence(const Equivalent&);

/// Share of what was asked for that is found, with that number of ways; of a policy, at that place of its list.
Estimate hit_rate(const LevelCurve&, const CurveRow&, std::uint64_t ways);
Estimate hit_rate(const LevelCurve&, const PolicyRow&, std::size_t at);
/// "L1"
std::string level_name(std::size_t level);
/// "L2-to-L1", "DRAM": where the bytes go that a level of a GPU with `levels` fetches.
std::string traffic_name(std::size_t level, std::size_t levels);
/// "own sets", "fully associative", "16 sets, xor_fold"
std::string row_name(const LevelCurve&, std::size_t row);

std::string to_text(const CurveReport&, std::size_t width = text_width);
std::string to_json(const CurveReport&);
std::string to_csv(const CurveReport&);

}  // namespace raycache::cachesim
