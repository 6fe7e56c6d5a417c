#include "tracer/quality/error_measures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>

namespace raycache::tracer {

namespace {

constexpr std::uint32_t tiles_per_side = 4;
constexpr std::size_t tile_count = std::size_t{tiles_per_side} * tiles_per_side;
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

using Color = std::array<double, 3>;

Color minus(Vec3 a, Vec3 b) { return {double{a.x} - b.x, double{a.y} - b.y, double{a.z} - b.z}; }
double square(const Color& c) { return (c[0] * c[0] + c[1] * c[1] + c[2] * c[2]) / 3; }
/// As luminance() of vec.hpp.
double luminance(const Color& c) { return 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2]; }

/// Sums over the pixels of one tile for one picture of errors.
struct TileSums {
    double pixels = 0, square = 0, relative_square = 0, luminance = 0, luminance_square = 0;
    double block_pixels = 0, in_blocks_square = 0, block_mean_square = 0;  ///< whole blocks; the last times 64
};
using Tiles = std::array<TileSums, tile_count>;

std::size_t tile_of(std::uint32_t x, std::uint32_t y, const Image& image) {
    const auto part = [](std::uint32_t at, std::uint32_t size) { return std::size_t{at} * tiles_per_side / size; };
    return part(y, image.height) * tiles_per_side + part(x, image.width);
}

using ErrorAt = std::function<Color(std::size_t pixel)>;

/// A block counts for the tile of its upper left pixel. `block_luminance`: adds the mean of each whole block.
Tiles sum_up(const Image& size, const ErrorAt& error, const std::vector<double>& relative_weight,
             std::vector<double>& block_luminance) {
    Tiles tiles;
    for (std::uint32_t y = 0; y < size.height; ++y)
        for (std::uint32_t x = 0; x < size.width; ++x) {
            const std::size_t p = std::size_t{y} * size.width + x;
            const Color e = error(p);
            TileSums& t = tiles[tile_of(x, y, size)];
            t.pixels += 1;
            t.square += square(e);
            t.relative_square += square(e) * relative_weight[p];
            t.luminance += luminance(e);
            t.luminance_square += luminance(e) * luminance(e);
        }
    constexpr double block_size = error_block * error_block;
    std::size_t block = 0;
    for (std::uint32_t top = 0; top + error_block <= size.height; top += error_block)
        for (std::uint32_t left = 0; left + error_block <= size.width; left += error_block) {
            TileSums& t = tiles[tile_of(left, top, size)];
            Color sum{};
            for (std::uint32_t y = top; y < top + error_block; ++y)
                for (std::uint32_t x = left; x < left + error_block; ++x) {
                    const Color e = error(std::size_t{y} * size.width + x);
                    t.in_blocks_square += square(e);
                    for (std::size_t c = 0; c < 3; ++c) sum[c] += e[c];
                }
            for (double& s : sum) s /= block_size;
            t.block_pixels += block_size;
            t.block_mean_square += block_size * square(sum);
            block_luminance[block++] += luminance(sum);
        }
    return tiles;
}

/// The figure of all tiles with its jackknife error; tiles without pixels do not count.
Measured jackknife(const std::function<double(const std::array<bool, tile_count>& taken)>& figure,
                   const std::array<bool, tile_count>& present) {
    Measured m{figure(present), not_a_number};
    std::vector<double> without;
    for (std::size_t t = 0; t < tile_count; ++t) {
        if (!present[t]) continue;
        auto taken = present;
        taken[t] = false;
        without.push_back(figure(taken));
    }
    const auto n = static_cast<double>(without.size());
    if (without.size() < 2) return m;
    double mean = 0, squares = 0;
    for (const double w : without) mean += w / n;
    for (const double w : without) squares += (w - mean) * (w - mean);
    m.error = std::sqrt((n - 1) / n * squares);
    return m;
}

}  // namespace

ErrorMeasures measure_errors(std::span<const Image> seeds, const Reference& reference) {
    const Image& truth = reference.mean;
    const std::size_t pixels = truth.pixels.size();
    const auto count = static_cast<double>(seeds.size());
    ErrorMeasures m{};

    for (const Vec3 pixel : truth.pixels) m.reference_luminance += luminance(minus(pixel, {}));
    m.reference_luminance /= static_cast<double>(pixels);
    std::vector<double> weight(pixels);
    const double floor = 0.01 * m.reference_luminance;
    for (std::size_t p = 0; p < pixels; ++p) {
        const double l = luminance(minus(truth.pixels[p], {})), scale = l * l + floor * floor;
        weight[p] = scale > 0 ? 1 / scale : 0;
    }

    m.blocks.columns = truth.width / error_block;
    m.blocks.rows = truth.height / error_block;
    std::vector<double> block_luminance(std::size_t{m.blocks.columns} * m.blocks.rows), ignored(block_luminance);
    std::vector<Tiles> errors;
    for (const Image& image : seeds)
        errors.push_back(sum_up(
            truth, [&](std::size_t p) { return minus(image.pixels[p], truth.pixels[p]); }, weight, block_luminance));
    const Tiles own = sum_up(
        truth, [&](std::size_t p) { return minus(reference.half_difference.pixels[p], {}); }, weight, ignored);
    for (const double sum : block_luminance) m.blocks.mean.push_back(static_cast<float>(sum / count));

    std::array<bool, tile_count> present;
    for (std::size_t t = 0; t < tile_count; ++t) present[t] = own[t].pixels > 0;
    /// Mean of a square over the tiles taken and over seeds, less the reference's.
    const auto mean_square = [&](double TileSums::*sum, double TileSums::*number, const auto& taken) {
        double squares = 0, references = 0, places = 0;
        for (std::size_t t = 0; t < tile_count; ++t) {
            if (!taken[t]) continue;
            for (const Tiles& tiles : errors) squares += tiles[t].*sum / count;
            references += own[t].*sum;
            places += own[t].*number;
        }
        return std::max(0.0, squares - references) / places;  // NaN for no place
    };
    const auto root = [&](double TileSums::*sum) {
        return jackknife([&](const auto& taken) { return std::sqrt(mean_square(sum, &TileSums::pixels, taken)); },
                         present);
    };
    m.rmse = root(&TileSums::square);
    m.relative_rmse = root(&TileSums::relative_square);
    m.r8 = jackknife(
        [&](const auto& taken) {
            return mean_square(&TileSums::block_mean_square, &TileSums::block_pixels, taken) * error_block *
                   error_block / mean_square(&TileSums::in_blocks_square, &TileSums::block_pixels, taken);
        },
        present);
    m.block_rmse = std::sqrt(mean_square(&TileSums::block_mean_square, &TileSums::block_pixels, present));
    double reference_square = 0;
    for (const TileSums& t : own) reference_square += t.square;
    m.reference_rmse = std::sqrt(reference_square / static_cast<double>(pixels));

    // Bias.
    double means = 0, variances_seeds = 0, picture_variance_pixels = 0, picture_variance_reference = 0;
    double scores = 0, scored_tiles = 0;  // sum of m_t^2 / v_t
    for (std::size_t t = 0; t < tile_count; ++t) {
        if (!present[t]) continue;
        const double n = own[t].pixels, reference_variance = own[t].luminance_square / (n * n);
        double mean = 0, squares = 0, spread = 0;
        for (const Tiles& tiles : errors) {
            mean += tiles[t].luminance / n / count;
            squares += tiles[t].luminance_square / count;
        }
        for (const Tiles& tiles : errors) spread += std::pow(tiles[t].luminance / n - mean, 2);
        means += mean * mean;
        const double pixel_variance =
            std::max(0.0, squares - own[t].luminance_square) / (n * n * count) + reference_variance;
        if (pixel_variance > 0) {
            scores += mean * mean / pixel_variance;
            scored_tiles += 1;
        }
        if (seeds.size() > 1) variances_seeds += spread / (count - 1) / count + reference_variance;
        const double share = n / static_cast<double>(pixels);
        m.mean_error += share * mean;
        picture_variance_pixels += share * share * pixel_variance;
        picture_variance_reference += share * share * reference_variance;
    }
    m.z_pixels = std::sqrt(scores / scored_tiles);  // NaN for no tile with an error
    m.mean_error_deviation = std::sqrt(picture_variance_pixels);
    if (seeds.size() > 1) {
        m.z_seeds = std::sqrt(means / variances_seeds);
        double spread = 0;
        for (const Tiles& tiles : errors) {
            double picture = 0;
            for (const TileSums& t : tiles) picture += t.luminance / static_cast<double>(pixels);
            spread += (picture - m.mean_error) * (picture - m.mean_error);
        }
        m.mean_error_deviation = std::sqrt(spread / (count - 1) / count + picture_variance_reference);
    }
    return m;
}

std::optional<WorstBlock> worst_block(const ErrorMeasures& errors) {
    std::optional<WorstBlock> worst;
    for (std::uint32_t b = 0; b < errors.blocks.mean.size(); ++b) {
        const double mean = errors.blocks.mean[b];
        if (worst && !(std::fabs(mean) > std::fabs(worst->mean_error))) continue;
        worst = WorstBlock{b % errors.blocks.columns * error_block, b / errors.blocks.columns * error_block, mean};
    }
    return worst;
}

}  // namespace raycache::tracer
