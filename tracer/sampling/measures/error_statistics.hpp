// What a sampling strategy's errors look like over a picture: how large, whether they cancel in the mean, whether
// neighbours err together.
#pragma once

#include <cstdint>
#include <span>

#include "tracer/sampling/measures/test_integrands.hpp"
#include "tracer/sampling/sampling_strategy.hpp"

namespace raycache::tracer {

struct ErrorStatistics {
    double mean = 0;            ///< of the errors: the bias, but for chance
    double standard_error = 0;  ///< of `mean`, if the pixels' errors were independent
    double mse = 0;             ///< mean squared error
    /// Structured-noise index: 64 * MSE of the means of 8x8 blocks / MSE. 1 for independent errors, 64 where whole
    /// blocks err alike. 1 if there is no error at all.
    double r8 = 1;

    /// Bias test: |z| is rarely above 2 for an unbiased strategy with independent pixels. 0 if there is no error.
    double z() const { return standard_error > 0 ? mean / standard_error : 0; }
    /// Share of the squared error that all pixels have in common.
    double common() const { return mse > 0 ? mean * mean / mse : 0; }
};

/// Of a square picture's errors, row by row; its side is a multiple of 8.
ErrorStatistics error_statistics(std::span<const double> errors, std::uint32_t side);

/// The errors of all 64x64 pixels with all N samples each. The strategy needs `integrand.dimensions` dimensions.
std::vector<double> errors_of(const SamplingStrategy&, const TestIntegrand&);

}  // namespace raycache::tracer
