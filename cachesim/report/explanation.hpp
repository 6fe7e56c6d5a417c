// Why one trace causes more cache traffic than another on the same GPU: the traffic identity factor by factor, misses
// by class, kind of object, BVH depth and bounce, and whom L1 hits are owed to.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cachesim/analysis/findings.hpp"
#include "cachesim/analysis/speed_up.hpp"
#include "cachesim/replay/statistics.hpp"
#include "cachesim/report/report.hpp"
#include "cachesim/report/verdict.hpp"

namespace raycache::cachesim {

/// One of the two traces.
struct ExplainedTrace {
    std::string name;                        ///< in tables: what tells it from the other, such as the strategy
    std::vector<LaunchStatistics> launches;  ///< one for each sample index, ascending
    Findings findings;                       ///< of all launches together

    Counters totals() const;
    std::vector<Counters> by_launch() const;
};

struct Explanation {
    std::string scene, gpu;
    std::uint64_t spp = 0;  ///< N of the base
    std::uint32_t sector_bytes = 32;
    GroupBy by = GroupBy::none;  ///< how the identity is cut; not by object
    ExplainedTrace base, other;  ///< of the same sample indices
    /// The timed replays of idealised_replays(); empty if the GPU has no [timing], or no time is predicted for it: then
    /// `no_time` says why (no_time_note()).
    std::vector<SpeedUp> speed_ups;
    std::string no_time;
    std::string traversal = "software";  ///< of those replays: traversal_name() of the GPU
    /// Where the launches are blocks of windows: the last cache is full if it is for both; speed_ups are as wide.
    std::optional<WindowSample> windows{};
    std::vector<std::string> cache_equivalents{};  ///< where asked for: to_sentence() of an Equivalent each

    double widening() const { return windows ? windows->widening : 1; }
    /// Of `other` over `base`; none where a quotient has no value.
    std::optional<Factors> factors() const { return factors_of(base.by_launch(), other.by_launch()); }
    /// The same of a part of both.
    std::optional<Factors> factors_of(const std::vector<Counters>& base, const std::vector<Counters>& other) const;
    /// What a figure that compares says of such a part.
    Estimate ratio_of(TrafficKey, const std::vector<Counters>& base, const std::vector<Counters>& other) const;
    CacheUnits caches() const { return {base.findings.levels.size(), sector_bytes}; }
};

/// Tables of at most `width` columns where they can be so narrow.
std::string to_text(const Explanation&, std::size_t width = text_width);
std::string to_json(const Explanation&);

/// The finding about bytes in one sentence, level by level, made from the numbers: no difference is claimed, and no
/// cause named, of a ratio whose interval holds 1. That about time: sentence(speed_ups).
std::string sentence(const Explanation&);

/// What a figure that compares, such as "dram_bytes_ratio", says of `other` against `base`, paired by sample index.
Estimate ratio(const Explanation&, TrafficKey);

/// What there is to say of `other` against `base`, the predicted time included.
Difference difference_of(const Explanation&);

/// The verdict on each row of a report that has a ratio, one after the other.
std::string factor_sentences(const Report&);

}  // namespace raycache::cachesim
