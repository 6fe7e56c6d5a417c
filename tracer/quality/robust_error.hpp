// What a handful of pixels does to a squared error: an error that they cannot decide, and whether they decided one.
#pragma once

#include <cstdint>
#include <optional>

#include "tracer/quality/error_interval.hpp"

namespace raycache::tracer {

inline constexpr std::size_t robust_groups = 25;

/// Root of the median of means: pixels are dealt at random into 25 groups, each with its mean squared error; the median
/// of the 25 (A. Nemirovsky, D. Yudin, Problem complexity and method efficiency in optimization, 1983; for pictures: J.
/// Buisine, S. Delepoulle, C. Renaud, Firefly removal in Monte Carlo rendering with adaptive median of means, EGSR
/// 2021). Up to 12 pixels, however bright, leave it within the range of the other groups. For skewed errors it is below
/// the RMSE. half_width: from the 8th and the 18th of the 25, between which the median lies with 95.7 % confidence. NaN
/// for less than 25 pixels.
Measured median_of_means(const ErrorSums&);

/// How many pixels count as a handful: one in 10 000, at least 3, of less than 1024 pixels one.
std::size_t handful(std::size_t pixels);

/// The pixels that decide.
struct FewPixels {
    std::size_t count = 0;
    double share = 0;         ///< of the squared error of the whole picture
    std::size_t largest = 0;  ///< index of the pixel with the largest share
};

/// At most a handful of pixels that together hold half of the squared error, if there are such.
std::optional<FewPixels> few_pixels(const ErrorSums&);

/// Whether the sign of a's squared error less b's changes, or nothing of it is
/// left, when at most a handful of pixels is left out; the least such
/// number. Precondition: equal sizes.
std::optional<std::size_t> few_pixels_between(const ErrorSums& a, const ErrorSums& b);

}  // namespace raycache::tracer
