// What a launch from cold caches takes beside the steady state, as factors of their own.
//
// T: cycles, A: warp accesses of the launch and of its stages (LaunchStages). c: cycles per warp access in the steady
// state; r = T_full / A_full: the same while all slots are taken. Then
//     steady = c A                                        the steady state, for the accesses of this very launch
//     cold   = r / c                                      full SMs, but caches that still fill
//     ramp   = (T_filling + T_full + r A_draining) / (r A)  the beginning over its share at the rate of full SMs
//     tail   = T / (T_filling + T_full + r A_draining)    the same of the end, when no CTA is left to take a slot
// and steady x cold x ramp x tail = T exactly. `cold` also holds what tells this launch's sample index from others, and
// the error of c. Both are small where caches are what differs: cycles per access scatter little (docs/estimates.md).
#pragma once

#include "cachesim/replay/timed/launch_stages.hpp"

namespace raycache::cachesim {

struct LaunchFactors {
    double steady_cycles = 0;             ///< of the same accesses
    double over_steady = 0;               ///< cycles of the launch over these: cold x ramp x tail
    double cold = 0, ramp = 0, tail = 0;  ///< NaN where SMs are never all full with CTAs left to deal out
    double full_share = 0;                ///< A_full / A: where it is small, r is that of few
};

/// Of a launch, or of several added up. NaN where it would be divided by nothing.
LaunchFactors launch_factors(const LaunchStages&, double steady_cycles_per_access);

}  // namespace raycache::cachesim
