// Sums of squared errors, tile by tile and seed by seed: what figures about a picture's error, and their intervals, are
// made of.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "tracer/quality/reference.hpp"

namespace raycache::tracer {

inline constexpr std::uint32_t error_block = 8;                  ///< pixels on a side of a block
inline constexpr double block_size = error_block * error_block;  ///< pixels of a block

/// What is summed over pixels, or over the whole 8 x 8 blocks that begin in a tile. Squares are means over the channels
/// of linear RGB, and less what the reference's own error contributes (Reference): their expectation is the strategy's
/// alone, so that a sum may come out negative where the reference is noisy.
enum class ErrorSum {
    pixels,             ///< how many
    square,             ///< of a pixel's error
    relative_square,    ///< the same over L^2 + (0.01 m)^2; L: the reference's luminance, m: its mean over the picture
    luminance,          ///< of the error, signed
    luminance_square,   ///< of the error, the reference's share included
    block_pixels,       ///< pixels in whole blocks
    in_blocks_square,   ///< `square` of those
    block_mean_square,  ///< 64 * square of a block's mean error
};
inline constexpr std::size_t error_sum_count = 8;

struct ErrorTotals : std::array<double, error_sum_count> {
    double& operator[](ErrorSum s) {
        return std::array<double, error_sum_count>::operator[](static_cast<std::size_t>(s));
    }
    double operator[](ErrorSum s) const {
        return std::array<double, error_sum_count>::operator[](static_cast<std::size_t>(s));
    }
};

inline constexpr std::uint32_t error_tiles_per_side = 4;
inline constexpr std::size_t error_tile_count = std::size_t{error_tiles_per_side} * error_tiles_per_side;
using ErrorTiles = std::array<ErrorTotals, error_tile_count>;  ///< of a 4 x 4 grid; some are empty in tiny pictures

struct ErrorSums {
    std::vector<ErrorTiles> seeds;  ///< one picture each
    ErrorTiles reference{};         ///< the same sums of the reference's half difference (nothing taken off)
    /// Variance that the reference's own error gives each total (over all tiles, seeds averaged), zero for the counts:
    /// 4 sigma^2(p) e(p)^2 summed over pixels, sigma^2: the mean square of the half difference over the pixel's 8 x 8
    /// block, e: the strategy's mean difference to the reference, whose own error is in it. The exact variance of
    /// (e - a)(e - b) where a and b are the independent errors of the reference's halves and channels move together;
    /// more than that where they do not. For the luminance: that of the half difference.
    ErrorTotals noise{};

    struct Blocks {
        std::uint32_t columns = 0, rows = 0;  ///< whole blocks only
        std::vector<float> mean;              ///< mean error of luminance, over seeds
    } blocks;
    std::vector<float> pixel_square;  ///< each pixel's share of `square`, over seeds

    /// Over all tiles, seeds averaged.
    ErrorTotals totals() const;
};

/// Precondition: at least one picture; all as large as the reference.
ErrorSums sum_errors(std::span<const Image> seeds, const Reference&);

/// As luminance() of vec.hpp, of the reference, averaged over the picture.
double mean_luminance(const Reference&);

}  // namespace raycache::tracer
