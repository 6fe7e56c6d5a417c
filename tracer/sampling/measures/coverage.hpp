// How well the copies of a point set that micro-jitter makes cover the unit square, exactly, in 32-bit fixed point.
//
// A sample x_i of a pixel lies anywhere in the window of side mu centred on base point i, modulo 1. With many pixels
// the union of all copies is the union of these N windows. Where no window reaches is a hole: no pixel ever samples
// there (the paper's Figure 2). Where more windows overlap, samples are denser.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "tracer/sampling/measures/star_discrepancy.hpp"

namespace raycache::tracer {

/// Twice the dispersion of the points on the torus under the maximum norm (Niederreiter 1992, definition 6.2): the side
/// of the largest axis-parallel square, modulo 1, without a point inside. It is also the least window that leaves no
/// hole. 0 … 1; exact up to 2^-32. Time grows with N log N. Throws UsageError for no points.
double largest_empty_square(std::span<const FixedPoint2> points);

/// The same in one dimension: the longest gap between neighbouring points, modulo 1.
double largest_gap(std::span<const std::uint32_t> points);

/// The least K of mu = K * N^(-1/s) that leaves no hole: largest hole * N^(1/s), for s = 1 or 2 dimensions.
double hole_free_k(double largest_hole, std::uint64_t n, unsigned s);

/// Where the windows of one mu lie.
struct Coverage {
    /// Share of the square that k windows cover, k = 0, 1, 2, …
    std::vector<double> share;

    double holes() const { return share.empty() ? 1 : share.front(); }
    /// Density relative to an even one: k windows of side mu for N points are k / (N mu^2). The mean is 1.
    double density(std::size_t windows, std::uint64_t n, double mu) const;
    double least(std::uint64_t n, double mu) const;  ///< density where there is least
    double most(std::uint64_t n, double mu) const;
    /// Mean of (density - 1)^2: 0 if the union is even. It bounds the bias: |bias| <= ||f|| * its square root, by
    /// Cauchy and Schwarz.
    double uneven(std::uint64_t n, double mu) const;
};

/// Exact. mu: 2^-32 … 1. Time and memory grow with N^2: throws UsageError above `max_coverage_points` points.
Coverage coverage(std::span<const FixedPoint2> points, double mu);
inline constexpr std::uint32_t max_coverage_points = 4096;

}  // namespace raycache::tracer
