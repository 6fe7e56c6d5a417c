// Why one trace causes more cache traffic than another on the same GPU: the traffic identity factor by factor, misses
// by class, kind of object, BVH depth and bounce, and whom L1 hits are owed to.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "cachesim/analysis/findings.hpp"
#include "cachesim/analysis/speed_up.hpp"
#include "cachesim/replay/statistics.hpp"
#include "cachesim/report/report.hpp"

namespace raycache::cachesim {

/// One of the two traces.
struct ExplainedTrace {
    std::string name;                        ///< in tables: what tells it from the other, such as the strategy
    std::vector<LaunchStatistics> launches;  ///< one for each sample index, ascending
    Findings findings;                       ///< of all launches together

    Counters totals() const;
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

    std::size_t levels() const { return base.findings.levels.size(); }  ///< of the GPU's caches
};

/// Readable in 110 columns.
std::string to_text(const Explanation&);
std::string to_json(const Explanation&);

/// The finding about bytes in one sentence, made from the numbers. That about time: sentence(speed_ups).
std::string sentence(const Explanation&);

/// DRAM bytes per ray, or L2-to-L1 bytes, of `other` over those of `base`, paired by sample index.
Estimate dram_bytes_ratio(const Explanation&);
Estimate l2_bytes_ratio(const Explanation&);

/// One line for each row of a report that has factors: the ratio, and the factor that does most for it.
std::string factor_sentences(const Report&);

}  // namespace raycache::cachesim
