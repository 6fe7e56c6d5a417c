// How wrong a picture is, how much of the error neighbouring pixels share, and whether its mean is off.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "tracer/quality/reference.hpp"

namespace raycache::tracer {

inline constexpr std::uint32_t error_block = 8;  ///< pixels on a side of a block

/// A figure of the whole picture and its standard error: the delete-one jackknife over the tiles of a 4 x 4 grid (Efron
/// and Tibshirani, An Introduction to the Bootstrap, 1993, chapter 11). It shows how far a few very bright pixels
/// decide the figure. NaN where there is none (a picture smaller than a block, an error of zero).
struct Measured {
    double value, error;
};

/// All squares are means over pixels and the three channels, averaged over seeds, less what the reference's own error
/// contributes (see Reference), and not below zero.
struct ErrorMeasures {
    Measured rmse;  ///< root of the mean squared error MSE
    Measured
        relative_rmse;  ///< root of the mean of error^2 / (L^2 + (0.01 m)^2); L: reference's luminance, m: its mean
    /// Structured-noise index: 64 * mean square of the error's means over 8 x 8 blocks / MSE, over whole blocks. 1:
    /// every pixel errs on its own; 64: all pixels of a block err alike.
    Measured r8;
    double block_rmse;           ///< root of that mean square: the error left after averaging 8 x 8 pixels
    double reference_rmse;       ///< of the reference itself, as rmse
    double reference_luminance;  ///< its mean
    double mean_error;           ///< luminance, over the whole picture, signed
    double
        mean_error_deviation;  ///< standard error of mean_error: pixels independent; from the seeds where >= 2 differ
    /// Bias test over the tiles t of a 4 x 4 grid; m_t: a tile's mean error (luminance, over seeds), v_t: its variance.
    /// z_pixels: root of the mean of m_t^2 / v_t, v_t from the mean squared error of the tile's pixels, taken as
    /// independent of each other. Without bias about 1, above 1.4 in about one picture of a hundred (chi-square, 16
    /// degrees of freedom). Errors that neighbours share raise it as a bias does. NaN where there is no error.
    /// z_seeds: root of (sum of m_t^2 / sum of v_t), v_t from the spread of the tile's mean error between seeds, which
    /// assumes nothing about pixels: bias alone raises it. Few tiles may decide it, so it scatters more. Where seeds do
    /// not matter (coherent), all error is bias. Absent for one seed.
    double z_pixels;
    /// z_seeds: v_t from the spread of the tile's mean error between seeds, which assumes nothing about pixels: bias
    /// alone raises it. Where seeds do not matter (coherent), all error is bias. Absent for one seed.
    std::optional<double> z_seeds;

    struct Blocks {
        std::uint32_t columns = 0, rows = 0;  ///< whole blocks only
        std::vector<float> mean;              ///< mean error of luminance, over seeds
    } blocks;

    double mse() const { return rmse.value * rmse.value; }
    /// Mean squared error times the share of it that is shared: 0 for white noise.
    double structured_mse() const { return mse() * (r8.value - 1) / (error_block * error_block - 1); }
};

/// `seeds`: pictures of one strategy that differ in their seed. Precondition: at least one; all as large as the
/// reference.
ErrorMeasures measure_errors(std::span<const Image> seeds, const Reference&);

/// The block whose mean error is the largest in size: its upper left pixel, and that error (luminance, signed). None in
/// a picture without whole blocks.
struct WorstBlock {
    std::uint32_t x = 0, y = 0;
    double mean_error = 0;
};
std::optional<WorstBlock> worst_block(const ErrorMeasures&);

}  // namespace raycache::tracer
