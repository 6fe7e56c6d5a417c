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

    /// Cycles of the base over those of the other; above 1 the other is faster.
    Estimate value() const;
};

/// How much faster a trace is with one cost taken away than as modelled: cycles of each sample index, in the same
/// order.
Estimate gain(const std::vector<double>& as_modelled, const std::vector<double>& idealised);

/// Of a predicted speed-up, the factor that perfect caches leave out: value() as modelled over that with a perfect L1,
/// from all of idealised_replays() in their order.
Estimate locality_part(const std::vector<SpeedUp>&);

}  // namespace raycache::cachesim
