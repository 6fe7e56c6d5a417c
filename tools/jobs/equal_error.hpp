// Who is first at the same error: users buy time to an error, not N samples.
//
// With t(N) the predicted time and e(N)^2 the mean squared error of N samples, the time to an error e is
// t(N) e(N)^2 / e^2 where the squared error falls as 1/N and time grows as N. Of two strategies at the same N
//     gain = (t_base e_base^2) / (t_row e_row^2) = speed-up * variance ratio = speed-up / (RMSE ratio)^2
// the ratio of their efficiencies (efficiency = 1 / (variance * time): Hammersley & Handscomb, Monte Carlo Methods,
// 1964, section 5.1). Above 1: the row is there first. Interval by the delta method, since pictures and times are
// measured apart: (half width of the gain / gain)^2 = (that of the speed-up)^2 + (2 * that of the RMSE ratio)^2.
//
// The formula takes for granted that the error goes on falling. What pixels share and bias do not fall with N as noise
// does: where R8 or the test of bias shows either, a strategy has no time to an equal error. Where the squared error
// falls as N^-a with a > 1, as that of good nets does, (variance ratio)^(1/a) would be right: nearer to the speed-up.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cachesim/analysis/estimate.hpp"
#include "tracer/quality/error_measures.hpp"

namespace raycache::tools {

/// A row against another of the same N.
struct EqualError {
    std::size_t baseline = 0;     ///< row
    cachesim::Estimate speed_up;  ///< over it, at equal N
    tracer::RmseRatio ratio;      ///< to it, at equal N
    /// As if the RMSE were all of the error. Not known where one of the two is not.
    cachesim::Estimate gain;
};

/// Strategies that rows are held against at equal error, where they are compared: those whose error falls.
const std::vector<std::string>& equal_error_baselines();

/// Greatest R8 and z (ErrorMeasures) of a picture whose error falls with N.
inline constexpr double most_shared_error = 2, most_bias = 1.4;

/// Why the error does not fall: "R8 5.66 ±0.31, at most 2", "bias: z seeds 9.9, at most 1.4"; empty where nothing is
/// seen. `unbiased`: by construction, whatever a test says. R8 counts where its whole interval is above the limit.
std::string no_equal_error(const tracer::ErrorMeasures&, bool unbiased);

/// speed-up / ratio^2. NaN where either is not known, or a few pixels decide the ratio.
cachesim::Estimate gain_at_equal_error(const cachesim::Estimate& speed_up, const tracer::RmseRatio&);

}  // namespace raycache::tools
