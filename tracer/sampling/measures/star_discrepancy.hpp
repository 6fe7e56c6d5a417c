// Star discrepancy of a planar point set, exactly: the largest difference, over all boxes [0,x) x [0,y), between the
// box's area and the share of the points inside it. H. Niederreiter, "Random Number Generation and Quasi-Monte Carlo
// Methods", SIAM 1992, definition 2.1; computed at the critical boxes, those whose edges pass through points (or 1):
// P. Bundschuh, Y. Zhu, "A method for exact calculation of the discrepancy of low-dimensional finite point sets",
// Abhandlungen Math. Sem. Hamburg 63, 1993.
#pragma once

#include <cstdint>
#include <span>

namespace raycache::tracer {

/// A point of the unit square in 32-bit fixed point (u32 / 2^32), as sequences give them.
struct FixedPoint2 {
    std::uint32_t x = 0, y = 0;
};

/// D*_N of the points, 1/(2N) … 1. Points may repeat and share coordinates. Time grows with N^2 (a few seconds for
/// N = 65536), memory with N. Rounding errors are below 1e-15. Throws UsageError for no points, and for more than
/// `max_star_discrepancy_points`.
double star_discrepancy(std::span<const FixedPoint2> points);

inline constexpr std::uint32_t max_star_discrepancy_points = 1U << 16;

}  // namespace raycache::tracer
