// 95 % confidence intervals of figures made of ErrorSums.
//
// Two and more seeds: the stratified jackknife (K. M. Wolter, Introduction to Variance Estimation, 2007, chapter 4). A
// tile is a stratum, a seed a replicate within it: leave out one seed in one tile at a time; variances add up over the
// tiles, degrees of freedom by Satterthwaite. Tiles are taken as independent of each other unless whole pictures differ
// by more between seeds than that explains (F test at 5 %): then whole seeds are left out, R - 1 degrees of freedom.
// What stays the same for every seed does not count as uncertain: the figure is that of this picture.
//
// One seed: the delete-one jackknife over tiles (Efron and Tibshirani, An Introduction to the Bootstrap, 1993, chapter
// 11); degrees of freedom: (sum d^2)^2 / sum d^4 of its differences d, as few as the tiles that decide. It counts
// differences between parts of the picture as chance and is too wide rather than too narrow; seeds are the better
// evidence.
//
// In both, what the reference's own error adds (ErrorSums::noise) is in the interval. Half widths are Student's t times
// the standard error. tests/tracer/quality_intervals.cpp holds their coverage against pictures of known error.
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <span>

#include "tracer/quality/error_sums.hpp"

namespace raycache::tracer {

inline constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

/// A figure, value ± half_width with 95 % confidence. NaN: not known. Where the reference's noise hides it, `value` is
/// NaN and only a bound is known.
struct Measured {
    double value, half_width;
    std::optional<double> below{}, above{};  ///< it is less, or more, than that
    double reference_share = 0;              ///< of the variance: the reference's own noise
    bool resolved() const { return value == value; }
};

/// From the totals of one strategy or of several with equal seeds, in the order given. NaN: not defined.
using ErrorFigure = std::function<double(std::span<const ErrorTotals>)>;

/// Precondition: at least one strategy; all of the same size and number of seeds.
Measured error_interval(std::span<const ErrorSums* const> strategies, const ErrorFigure&);

}  // namespace raycache::tracer
