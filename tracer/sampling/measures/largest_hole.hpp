// The largest hole of a point set, and the K of micro-jitter that closes it.
//
// Hole: the largest open axis-aligned square (s = 2) or interval (s = 1) without a point, on the torus: opposite sides
// of the unit square are joined, as micro-jitter wraps. Its side is twice the dispersion of the set in the maximum norm
// (H. Niederreiter, "Random Number Generation and Quasi-Monte Carlo Methods", SIAM 1992, definition 6.2: the largest
// distance of any place to its nearest point).
//
// Jitter from a window of width mu moves a point over a square of side mu around it. These squares cover everything if
// and only if mu is at least the side of the hole. With mu = K * N^(-1/s) the points of all pixels together leave no
// hole if and only if K >= side * N^(1/s): the hole-free K.
#pragma once

#include <cstdint>
#include <span>

#include "tracer/sampling/measures/star_discrepancy.hpp"

namespace raycache::tracer {

/// Side of the hole, in units of 2^-32: 1 … 2^32, exact. Points may repeat. Time grows with N log N for points as
/// even as those of a sequence. Throws UsageError for no points.
std::uint64_t largest_hole(std::span<const FixedPoint2> points);
std::uint64_t largest_hole(std::span<const std::uint32_t> points);  ///< s = 1: the longest gap on the circle

/// The hole-free K: side * N^(1/s). Infinite precision of mu is assumed.
double hole_free_k(std::uint64_t side, std::uint64_t n, unsigned s);

}  // namespace raycache::tracer
