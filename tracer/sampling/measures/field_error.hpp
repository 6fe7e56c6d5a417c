// What a field of errors, one per pixel, says about a sampling strategy beside its size: whether the mean is off, and
// how much of the error neighbouring pixels share.
#pragma once

#include <cstdint>
#include <span>

namespace raycache::tracer {

struct FieldError {
    double mse = 0;  ///< mean squared error
    /// Bias test: |mean error| / sqrt(MSE / pixels). About 1 (root mean square over repetitions) where pixels err
    /// independently of each other and without bias; sqrt(pixels) where all err alike.
    double z = 0;
    /// Structured-noise index: 64 * mean square of the error's means over 8 x 8 blocks / MSE. 1: every pixel errs on
    /// its own; 64: all pixels of a block err alike.
    double r8 = 0;

    /// Share of the squared error that the pixels of a block have in common: an error of a shared and an independent
    /// part has R8 = 1 + 63 * share. May be slightly negative by chance.
    double structured() const { return (r8 - 1) / 63; }
};

/// `errors` row by row. Precondition: width and height are multiples of 8. An error of zero everywhere gives NaN for z
/// and r8.
FieldError measure_field(std::span<const double> errors, std::uint32_t width);

}  // namespace raycache::tracer
