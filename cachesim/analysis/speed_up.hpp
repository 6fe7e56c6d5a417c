// Where a predicted speed-up comes from: the same two launches, replayed again with one cost taken away at a time.
//
// What remains of a speed-up when every look-up hits L1 is work and SIMT efficiency, not locality. The rest is locality
// only as far as traffic falls with it: where warps do not fill the GPU, the time is that of the longest of them, and
// can change against the traffic.
#pragma once

#include <span>
#include <vector>

#include "cachesim/analysis/estimate.hpp"
#include "cachesim/replay/timed/timed_rules.hpp"
#include "cachesim/replay/timed/timed_statistics.hpp"

namespace raycache::cachesim {

struct NamedIdeal {
    const char* name;     ///< "perfect L1"
    const char* meaning;  ///< "every look-up in L1 hits"
    Idealised ideal;
};

/// The replay as modelled, then each idealised one, in the order of a report.
std::span<const NamedIdeal> idealised_replays();

/// One of them, of both traces; sums over the same sample indices.
struct SpeedUp {
    NamedIdeal replay;
    TimedStatistics base, other;
    std::vector<double> base_cycles, other_cycles;  ///< of each sample index, in the same order
    double widening = 1;                            ///< of all intervals: WindowSample::widening

    /// Cycles of the base over those of the other; above 1 the other is faster.
    Estimate value() const;
    /// How much faster each trace is with this cost taken away than as modelled.
    Estimate base_gain(const SpeedUp& as_modelled) const;
    Estimate other_gain(const SpeedUp& as_modelled) const;
};

/// Of a predicted speed-up, the factor that perfect caches leave out: value() as modelled over that with a perfect L1,
/// from all of idealised_replays() in their order.
Estimate locality_part(const std::vector<SpeedUp>&);

}  // namespace raycache::cachesim
