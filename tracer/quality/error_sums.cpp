#include "tracer/quality/error_sums.hpp"

#include <algorithm>

namespace raycache::tracer {

namespace {

using Color = std::array<double, 3>;

Color minus(Vec3 a, Vec3 b) { return {double{a.x} - b.x, double{a.y} - b.y, double{a.z} - b.z}; }
double squared(const Color& c) { return (c[0] * c[0] + c[1] * c[1] + c[2] * c[2]) / 3; }
double luminance(const Color& c) { return 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2]; }

std::size_t tile_of(std::uint32_t x, std::uint32_t y, const Image& image) {
    const auto part = [](std::uint32_t at, std::uint32_t size) {
        return std::size_t{at} * error_tiles_per_side / size;
    };
    return part(y, image.height) * error_tiles_per_side + part(x, image.width);
}

/// Calls f(x, y, pixel) for every pixel.
template <class F>
void for_pixels(const Image& size, F f) {
    for (std::uint32_t y = 0; y < size.height; ++y)
        for (std::uint32_t x = 0; x < size.width; ++x) f(x, y, std::size_t{y} * size.width + x);
}

/// Calls f(left, top, mean of `error` over the block) for every whole block.
template <class Error, class F>
void for_blocks(const Image& size, const Error& error, F f) {
    for (std::uint32_t top = 0; top + error_block <= size.height; top += error_block)
        for (std::uint32_t left = 0; left + error_block <= size.width; left += error_block) {
            Color sum{};
            for (std::uint32_t y = top; y < top + error_block; ++y)
                for (std::uint32_t x = left; x < left + error_block; ++x) {
                    const Color e = error(std::size_t{y} * size.width + x);
                    for (std::size_t c = 0; c < 3; ++c) sum[c] += e[c] / block_size;
                }
            f(left, top, sum);
        }
}

/// Sums of one picture of errors; nothing taken off. A block counts for the tile of its upper left pixel.
template <class Error>
ErrorTiles sum_up(const Image& size, const Error& error, const std::vector<double>& weight) {
    ErrorTiles tiles{};
    for_pixels(size, [&](std::uint32_t x, std::uint32_t y, std::size_t p) {
        const Color e = error(p);
        ErrorTotals& t = tiles[tile_of(x, y, size)];
        t[ErrorSum::pixels] += 1;
        t[ErrorSum::square] += squared(e);
        t[ErrorSum::relative_square] += squared(e) * weight[p];
        t[ErrorSum::luminance] += luminance(e);
        t[ErrorSum::luminance_square] += luminance(e) * luminance(e);
    });
    for_blocks(size, error, [&](std::uint32_t left, std::uint32_t top, const Color& mean) {
        ErrorTotals& t = tiles[tile_of(left, top, size)];
        t[ErrorSum::block_pixels] += block_size;
        t[ErrorSum::block_mean_square] += block_size * squared(mean);
        for (std::uint32_t y = top; y < top + error_block; ++y)
            for (std::uint32_t x = left; x < left + error_block; ++x)
                t[ErrorSum::in_blocks_square] += squared(error(std::size_t{y} * size.width + x));
    });
    return tiles;
}

/// Mean square of the half difference over each 8 x 8 block, cut off at the border.
class ReferenceVariance {
public:
    explicit ReferenceVariance(const Image& half_difference)
        : columns_((half_difference.width + error_block - 1) / error_block) {
        const std::uint32_t rows = (half_difference.height + error_block - 1) / error_block;
        mean_.resize(std::size_t{columns_} * rows);
        std::vector<double> count(mean_.size());
        for_pixels(half_difference, [&](std::uint32_t x, std::uint32_t y, std::size_t p) {
            mean_[cell(x, y)] += squared(minus(half_difference.pixels[p], {}));
            count[cell(x, y)] += 1;
        });
        for (std::size_t c = 0; c < mean_.size(); ++c) mean_[c] /= count[c];
    }
    double at(std::uint32_t x, std::uint32_t y) const { return mean_[cell(x, y)]; }

private:
    std::size_t cell(std::uint32_t x, std::uint32_t y) const {
        return std::size_t{y / error_block} * columns_ + x / error_block;
    }
    std::uint32_t columns_;
    std::vector<double> mean_;
};

}  // namespace

double mean_luminance(const Reference& reference) {
    double sum = 0;
    for (const Vec3 pixel : reference.mean.pixels) sum += luminance(minus(pixel, {}));
    return sum / static_cast<double>(reference.mean.pixels.size());
}

ErrorTotals ErrorSums::totals() const {
    ErrorTotals sum{};
    for (const ErrorTiles& tiles : seeds)
        for (const ErrorTotals& t : tiles)
            for (std::size_t f = 0; f < error_sum_count; ++f) sum.at(f) += t.at(f) / static_cast<double>(seeds.size());
    return sum;
}

ErrorSums sum_errors(std::span<const Image> seeds, const Reference& reference) {
    const Image& truth = reference.mean;
    const std::size_t pixels = truth.pixels.size();
    std::vector<double> weight(pixels);
    const double floor = 0.01 * mean_luminance(reference);
    for (std::size_t p = 0; p < pixels; ++p) {
        const double l = luminance(minus(truth.pixels[p], {})), scale = l * l + floor * floor;
        weight[p] = scale > 0 ? 1 / scale : 0;
    }
    const auto own = [&](std::size_t p) { return minus(reference.half_difference.pixels[p], {}); };
    ErrorSums sums;
    sums.reference = sum_up(truth, own, weight);

    std::vector<Color> mean(pixels);
    std::vector<double> mean_square(pixels);
    const auto count = static_cast<double>(seeds.size());
    for (const Image& image : seeds) {
        const auto error = [&](std::size_t p) { return minus(image.pixels[p], truth.pixels[p]); };
        ErrorTiles& tiles = sums.seeds.emplace_back(sum_up(truth, error, weight));
        for (std::size_t t = 0; t < error_tile_count; ++t)
            for (const ErrorSum s :
                 {ErrorSum::square, ErrorSum::relative_square, ErrorSum::in_blocks_square, ErrorSum::block_mean_square})
                tiles[t][s] -= sums.reference[t][s];
        for (std::size_t p = 0; p < pixels; ++p) {
            const Color e = error(p);
            for (std::size_t c = 0; c < 3; ++c) mean[p][c] += e[c] / count;
            mean_square[p] += squared(e) / count;
        }
    }
    for (std::size_t p = 0; p < pixels; ++p)
        sums.pixel_square.push_back(static_cast<float>(mean_square[p] - squared(own(p))));

    const ReferenceVariance variance(reference.half_difference);
    for_pixels(truth, [&](std::uint32_t x, std::uint32_t y, std::size_t p) {
        const double v = 4 * variance.at(x, y) * squared(mean[p]);
        sums.noise[ErrorSum::square] += v;
        sums.noise[ErrorSum::relative_square] += v * weight[p] * weight[p];
        const bool in_block =
            x / error_block < truth.width / error_block && y / error_block < truth.height / error_block;
        if (in_block) sums.noise[ErrorSum::in_blocks_square] += v;
    });
    for (const ErrorTotals& t : sums.reference) sums.noise[ErrorSum::luminance] += t[ErrorSum::luminance_square];
    sums.blocks.columns = truth.width / error_block;
    sums.blocks.rows = truth.height / error_block;
    for_blocks(
        truth, [&](std::size_t p) { return mean[p]; },
        [&](std::uint32_t left, std::uint32_t top, const Color& e) {
            sums.blocks.mean.push_back(static_cast<float>(luminance(e)));
            // The reference's pixels are independent: its block mean has a 64th of the variance.
            sums.noise[ErrorSum::block_mean_square] +=
                block_size * block_size * 4 * (variance.at(left, top) / block_size) * squared(e);
        });
    return sums;
}

}  // namespace raycache::tracer
