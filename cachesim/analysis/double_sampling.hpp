// A speed-up in two phases: what is dear to measure over few units, what is cheap and goes along with it over many
// (double sampling with a ratio estimator: Cochran, Sampling Techniques, 1977, sections 12.8 and 12.9).
//
// Units are blocks of sample indices, of which both strategies have the same. Of n units cycles T and work W are known,
// of n' >= n units, the same n among them, W alone. With sums over all units that are known,
//     by time = T' / T over n,   by work = W' / W over n',   D = (T' / T) / (W' / W) over n,   Q = by work x D
// where ' marks the baseline. Per unit, to first order and relative to the means over n,
//     e_i = T'_i / mean(T') - T_i / mean(T),   d_i = e_i - (W'_i / mean(W') - W_i / mean(W))
//     var Q = Q^2 (s_d^2 (1/n - 1/n') + s_e^2 / n'),   s^2 = sum of squares / (n - 1)
// With n' = n that is the paired ratio of cycles alone (cachesim/analysis/estimate.hpp). half width = t(0.975, n - 1)
// sqrt(var). D is what cycles tell that work does not: 1 where time follows work.
#pragma once

#include <cstddef>
#include <vector>

#include "cachesim/analysis/estimate.hpp"

namespace raycache::cachesim {

/// Of one strategy, unit by unit: of all units work, of the first ones cycles, too.
struct TwoPhases {
    std::vector<double> cycles, work;
};

struct TwoPhaseSpeedUp {
    Estimate by_work;                                 ///< over all units
    Estimate by_time;                                 ///< over those with cycles
    Estimate difference;                              ///< D
    Estimate value;                                   ///< Q
    double variance = 0, variance_of_difference = 0;  ///< s_e^2, s_d^2; NaN of one unit
};

/// Both have the same units. `widening`: of all intervals (widening() in estimate.hpp).
TwoPhaseSpeedUp two_phase_speed_up(const TwoPhases& baseline, const TwoPhases& own, double widening);

/// The half width, over the estimate, that n units with cycles among n_work in all are expected to give.
double expected_error(const TwoPhaseSpeedUp&, std::size_t n, std::size_t n_work, double widening);

}  // namespace raycache::cachesim
