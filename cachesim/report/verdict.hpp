// What a comparison found, in one sentence that claims no more than its intervals allow.
//
// It speaks of the first level where the difference is certain: predicted time, then L2-to-L1 bytes, L3-to-L2 bytes,
// DRAM bytes. Certain: the 95 % confidence interval of the ratio, paired by sample index, does not hold 1. Where no
// level is certain it says how large a difference could be at most and what would narrow the interval.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cachesim/analysis/traffic_identity.hpp"
#include "cachesim/report/report.hpp"

namespace raycache::cachesim {

/// Ratios of one strategy to its baseline.
struct Difference {
    std::optional<Estimate> speed_up;  ///< predicted cycles of the baseline over the strategy's
    /// Bytes per ray over the baseline's, by level of cache: what it fetches from the one below, the last from DRAM.
    std::vector<Estimate> bytes;
    std::optional<Factors> factors;
    double dram_compulsory_share = 0;  ///< of the strategy; see Row
    std::size_t traced = 0;            ///< sample indices; blocks of them where `windows` says so
    std::optional<WindowSample> windows{};
    std::uint64_t spp = 0;  ///< N
};

struct Verdict {
    std::string text;                  ///< no full stop at its end
    std::optional<std::string> level;  ///< the first certain one: "time", "l2_bytes", "l3_bytes", "dram_bytes"
};

/// Bytes per ray that a level of caches fetches from below, and their ratio to the baseline's.
struct BytesFigures {
    TrafficKey mean, ratio;
};
/// Of all levels of a GPU, which has two or three: L2-to-L1, L3-to-L2 and DRAM bytes.
std::span<const BytesFigures> bytes_figures(std::size_t levels);

/// Of a row of a report; no predicted time.
Difference difference_of(const Row&);

Verdict verdict(const Difference&);

/// What to know of DRAM bytes of these GPUs, whose share of compulsory misses is that large.
std::string compulsory_note(const std::string& gpus);

/// From this share on, DRAM bytes are said to be compulsory misses.
inline constexpr double mostly_compulsory = 0.95;

/// Whether the interval of a ratio does not hold 1. Without an interval nothing is certain.
bool is_certain(const Estimate& ratio);

/// "57.0 ±6.1 % fewer", "4.1 % more", "as many": what a ratio of bytes means.
std::string change_of(const Estimate& ratio);
/// "12.1 % fewer to 3.0 % more": the ends of its interval.
std::string range_of(const Estimate& ratio);
/// ", most by SIMT efficiency, x0.818 ±0.020 (fewer warp accesses per step: less divergence)"; nothing without a cause.
/// Of the traffic below level `level`, from 0.
std::string cause_text(const std::optional<Factors>&, std::size_t level);
/// "raise --trace-samples from 4 to about 20": what would make the surest of these ratios certain. Of windows, how many.
std::string remedy(const Difference&);

}  // namespace raycache::cachesim
