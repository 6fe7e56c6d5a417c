// How evenly the points of all pixels together are spread: the density of a point set whose points are jittered by
// windows, in the limit of infinitely many pixels. It is the set filtered by a box of side mu:
//     density(y) = (number of points whose box holds y) / (N mu^2),      mean 1.
// The mean over pixels of an estimate is the integral of f * density, so its bias is the integral of
// f * (density - 1): none at all where the density is 1 everywhere, and no sample where it is 0 (a hole).
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "tracer/sampling/measures/star_discrepancy.hpp"
#include "tracer/sampling/sampling_strategy.hpp"

namespace raycache::tracer {

/// Where the value of a point, x in one dimension, lies over all pixels: uniformly in [a, a + width), modulo 2^32,
/// a = (x & leading_bits) - left.
struct JitterWindow {
    std::uint64_t left = 0, width = 0;  ///< units of 2^-32; width 0: the point itself, 2^32: anywhere
    std::uint32_t leading_bits = ~0U;
};

/// For coherent, micro-jitter, scrambling-distance, net-micro-jitter, uniform-jitter, and what is uniform over all
/// pixels whatever the sequence (cranley-patterson, owen, random, blue-noise). Empty where pixels fall into classes
/// (interleaved, net-micro-jitter-fast). The window of `dimension`. Precondition: the strategy is a defined
/// pair.
std::optional<JitterWindow> jitter_window(const StrategySettings&, std::uint32_t dimensions, std::uint32_t dimension);

struct UnionDensity {
    double min = 0, max = 0;
    double mean_square = 0;  ///< 1 for an even spread
    struct Level {
        std::uint64_t covered_by;  ///< number of boxes
        double density;
        double area;  ///< share of the unit square
    };
    std::vector<Level> levels;  ///< ascending, areas above 0 only; the areas add up to 1

    double holes() const { return levels.front().covered_by == 0 ? levels.front().area : 0; }
};

/// Exact: areas of integer rectangles. Time grows with N + N^2 mu^2. Throws UsageError for no points and for a window
/// of width 0, whose density is not a number.
UnionDensity union_density(std::span<const FixedPoint2> points, const JitterWindow&);

}  // namespace raycache::tracer
