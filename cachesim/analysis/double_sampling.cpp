#include "cachesim/analysis/double_sampling.hpp"

#include <cmath>
#include <limits>
#include <numeric>

namespace raycache::cachesim {
namespace {

/// Of the first n.
double mean_of(const std::vector<double>& values, std::size_t n) {
    return std::accumulate(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(n), 0.0) /
           static_cast<double>(n);
}

double variance_of(const std::vector<double>& deviations) {
    if (deviations.size() < 2) return std::numeric_limits<double>::quiet_NaN();
    double squares = 0;
    for (const double d : deviations) squares += d * d;
    return squares / static_cast<double>(deviations.size() - 1);
}

Estimate with_relative_error(double mean, double error) {
    if (!std::isfinite(mean) || !std::isfinite(error)) return {mean, {}};
    return {mean, std::fabs(mean) * error};
}

}  // namespace

TwoPhaseSpeedUp two_phase_speed_up(const TwoPhases& baseline, const TwoPhases& own, double widening) {
    const std::size_t n = own.cycles.size(), all = own.work.size();
    const double base_time = mean_of(baseline.cycles, n), own_time = mean_of(own.cycles, n);
    const double base_work = mean_of(baseline.work, n), own_work = mean_of(own.work, n);
    std::vector<double> e(n), d(n);
    for (std::size_t i = 0; i < n; ++i) {
        e[i] = baseline.cycles[i] / base_time - own.cycles[i] / own_time;
        d[i] = e[i] - (baseline.work[i] / base_work - own.work[i] / own_work);
    }
    TwoPhaseSpeedUp s;
    s.variance = variance_of(e);
    s.variance_of_difference = variance_of(d);
    const std::vector<double> ones(all, 1.0), few(n, 1.0);
    s.by_work = widened(ratio_to_baseline({baseline.work, ones}, {own.work, ones}), widening);
    s.by_time = widened(ratio_to_baseline({baseline.cycles, few}, {own.cycles, few}), widening);
    const double t = n > 1 ? student_t_975(n - 1) * widening : std::numeric_limits<double>::quiet_NaN();
    s.difference = with_relative_error(s.by_time.mean / (base_work / own_work),
                                       t * std::sqrt(s.variance_of_difference / static_cast<double>(n)));
    // Where all units have cycles, work cancels; and may be nothing.
    s.value = with_relative_error(all == n ? s.by_time.mean : s.by_work.mean * s.difference.mean,
                                  expected_error(s, n, all, widening));
    return s;
}

double expected_error(const TwoPhaseSpeedUp& s, std::size_t n, std::size_t n_work, double widening) {
    if (n < 2) return std::numeric_limits<double>::infinity();
    const double few = 1 / static_cast<double>(n), many = 1 / static_cast<double>(n_work);
    const double of_difference = n_work > n ? s.variance_of_difference * (few - many) : 0;
    return student_t_975(n - 1) * widening * std::sqrt(of_difference + s.variance * many);
}

}  // namespace raycache::cachesim
