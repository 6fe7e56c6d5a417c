// How wrong a picture is, how much of the error neighbouring pixels share, and whether its mean is off.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "tracer/quality/error_interval.hpp"
#include "tracer/quality/error_sums.hpp"
#include "tracer/quality/robust_error.hpp"

namespace raycache::tracer {

/// Squares are means over pixels and the three channels, averaged over seeds, less what the reference's own error
/// contributes. Where a mean square is not above 0 by 1.96 standard deviations of that contribution's own error, the
/// reference's noise hides it: the figure made of it is not resolved, only bounded (Measured::below). An error of
/// exactly 0 against a reference without noise is 0.
struct ErrorMeasures {
    Measured rmse;           ///< root of the mean squared error MSE
    Measured relative_rmse;  ///< root of the mean of error^2 / (L^2 + (0.01 m)^2), see ErrorSum
    Measured robust_rmse;    ///< median_of_means()
    /// Structured-noise index: 64 * mean square of the error's means over 8 x 8 blocks / MSE, over whole blocks. 1:
    /// every pixel errs on its own; 64: all pixels of a block err alike. NaN without whole blocks or where the MSE is 0
    /// or hidden by the reference's noise.
    Measured r8;
    Measured block_rmse;         ///< root of that mean square: the error left after averaging 8 x 8 pixels
    Measured mean_error;         ///< luminance, over the whole picture, signed
    double reference_rmse;       ///< of the reference itself, as rmse
    double reference_luminance;  ///< its mean
    /// MSE * (R8 - 1) / 63: the part of the mean squared error that is shared, 0 for white noise. From the sums as they
    /// are, so that it may be negative.
    double structured_mse;
    /// Bias test over the tiles t of a 4 x 4 grid; m_t: a tile's mean error (luminance, over seeds), v_t: its variance.
    /// z_pixels: root of the mean of m_t^2 / v_t, v_t from the mean squared error of the tile's pixels, taken as
    /// independent of each other. Without bias about 1, above 1.4 in about one picture of a hundred (chi-square, 16
    /// degrees of freedom). Errors that neighbours share raise it as a bias does. NaN where there is no error.
    /// z_seeds: root of (sum of m_t^2 / sum of v_t), v_t from the spread of the tile's mean error between seeds, which
    /// assumes nothing about pixels: bias alone raises it. Few tiles may decide it, so it scatters more. Where seeds do
    /// not matter (coherent), all error is bias. Absent for one seed.
    double z_pixels;
    std::optional<double> z_seeds;

    std::optional<FewPixels> few_pixels;  ///< that hold half of the MSE
    ErrorSums sums;
};

/// `seeds`: pictures of one strategy that differ in their seed. Precondition: at least one; all as large as the
/// reference.
ErrorMeasures measure_errors(std::span<const Image> seeds, const Reference&);

/// RMSE of `row` over that of `baseline`, paired tile by tile and seed by seed, and why there is none.
struct RmseRatio {
    Measured value;
    Measured robust;  ///< of the robust RMSEs; without a half width
    /// Instead of a value: at most a handful of pixels decide which of the two is larger, or hold half of one's squared
    /// error.
    std::optional<std::size_t> decided_by_pixels;
    bool baseline_is_zero = false;
};
RmseRatio rmse_ratio(const ErrorMeasures& row, const ErrorMeasures& baseline);

/// The block whose mean error is the largest in size: its upper left pixel, and that error (luminance, signed). None in
/// a picture without whole blocks.
struct WorstBlock {
    std::uint32_t x = 0, y = 0;
    double mean_error = 0;
};
std::optional<WorstBlock> worst_block(const ErrorMeasures&);

}  // namespace raycache::tracer
