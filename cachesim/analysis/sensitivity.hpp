// How far a predicted speed-up hangs on values of a GPU that no one has measured (docs/sensitivity.md).
//
// A speed-up is measured at the file's values by one sample, and at other values by a sample that may be smaller: what
// changes is told by that one alone, as a ratio of two speed-ups of the same blocks, and multiplied with the first (a
// ratio estimator in double sampling: Cochran, Sampling Techniques, 1977, chapter 12):
//     S(v) = S(file) r(v),   r(v) = s(v) / s(file),   (h_S(v) / S(v))^2 = (h_S(file) / S(file))^2 + (h_r / r)^2
// where h are half widths. Where both samples are the same, S(v) is s(v) itself.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "cachesim/analysis/estimate.hpp"
#include "cachesim/gpus/gpu_ranges.hpp"

namespace raycache::cachesim {

/// What a replay in time counts of each block, or each launch.
struct TimedSums {
    std::vector<double> cycles, rays;
};

/// Cycles of the baseline over those of the strategy, for as many sample indices of each.
Estimate speed_up_per_index(const TimedSums& baseline, const TimedSums& other);
/// The same for as many rays of each.
Estimate speed_up_per_ray(const TimedSums& baseline, const TimedSums& other);

/// The GPU with other values.
struct VariedPoint {
    std::vector<ChosenValue> values;
    Estimate change;              ///< r above: of the speed-up, by these values; the same per index and per ray
    Estimate per_index, per_ray;  ///< the speed-up
};

/// One strategy on one GPU.
struct Sensitivity {
    std::string gpu, strategy, baseline;
    Estimate per_index, per_ray;          ///< at the values of the file
    std::vector<GpuValue> open;           ///< values that were varied, in the order of the file
    std::vector<VariedPoint> one_by_one;  ///< one value each, for each of `open` its other values in turn
    std::vector<VariedPoint> hypercube;   ///< all at once
    std::vector<std::string> unread;      ///< keys with a range that these replays do not read
};

/// A point from the sums of baseline and strategy. `base`, `other`: with these values, `base_file`, `other_file`: with
/// the file's, all four of the same blocks. `whole_sample`: these blocks are all there are.
VariedPoint varied_point(std::vector<ChosenValue> values, const TimedSums& base, const TimedSums& other,
                         const TimedSums& base_file, const TimedSums& other_file, const Sensitivity& at_file,
                         bool whole_sample);

/// What one value does.
struct Effect {
    std::string key, value;             ///< as the file has it
    std::string low_value, high_value;  ///< of those tried, the ends of a range; of choices, slowest and fastest
    Estimate low, high;                 ///< speed-ups per sample index there
    double swing = 0;                   ///< largest less smallest speed-up, that of the file included
    bool certain = false;               ///< some other value changes the speed-up for certain
    std::vector<std::size_t> points;    ///< of Sensitivity::one_by_one
};
/// The largest swing first; of equal ones, the file's order.
std::vector<Effect> ranked_effects(const Sensitivity&);

/// The p-quantile of speed-ups per index of the hypercube, by linear interpolation between order statistics
/// (Hyndman & Fan 1996, definition 7). 0 for none.
double hypercube_quantile(const Sensitivity&, double p);

enum class Outcome { faster, slower, not_known };
struct SensitivityVerdict {
    Outcome outcome = Outcome::not_known;
    std::string text;  ///< "faster whatever is assumed"
};
enum class Per { index, ray };
/// Of all points: a speed-up that is certainly above 1 at each, or below. Else it is not known: it depends on the
/// values that move it to the other side of 1 for certain, or the sample is too small to tell.
SensitivityVerdict verdict_of(const Sensitivity&, Per);

}  // namespace raycache::cachesim
