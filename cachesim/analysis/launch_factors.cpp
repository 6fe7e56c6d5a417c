#include "cachesim/analysis/launch_factors.hpp"

#include <limits>

namespace raycache::cachesim {
namespace {

double quotient_or_nan(double y, double x) { return x > 0 ? y / x : std::numeric_limits<double>::quiet_NaN(); }

}  // namespace

LaunchFactors launch_factors(const LaunchStages& stages, double steady_cycles_per_access) {
    const auto cycles = [](const LaunchStages::Stage& s) { return static_cast<double>(s.cycles); };
    const auto accesses = [](const LaunchStages::Stage& s) { return static_cast<double>(s.warp_accesses); };
    const LaunchStages::Stage all = stages.all();
    // Of no time, or of no access: SMs were not full long enough to have a rate.
    const double rate = stages.full.cycles > 0 ? quotient_or_nan(cycles(stages.full), accesses(stages.full))
                                               : std::numeric_limits<double>::quiet_NaN();
    const double without_tail = cycles(stages.filling) + cycles(stages.full) + rate * accesses(stages.draining);
    LaunchFactors f;
    f.steady_cycles = steady_cycles_per_access * accesses(all);
    f.over_steady = quotient_or_nan(cycles(all), f.steady_cycles);
    f.cold = quotient_or_nan(rate, steady_cycles_per_access);
    f.ramp = quotient_or_nan(without_tail, rate * accesses(all));
    f.tail = quotient_or_nan(cycles(all), without_tail);
    f.full_share = quotient_or_nan(accesses(stages.full), accesses(all));
    return f;
}

}  // namespace raycache::cachesim
