#include "tracer/quality/error_measures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace raycache::tracer {

namespace {

constexpr double normal_975 = 1.959963984540054;

using Totals = std::span<const ErrorTotals>;

Measured interval(const ErrorSums& sums, const ErrorFigure& figure) {
    const ErrorSums* one = &sums;
    return error_interval({&one, 1}, figure);
}

/// Whether the reference's noise hides that sum.
bool hidden(const ErrorSums& sums, const ErrorTotals& totals, ErrorSum sum) {
    return sums.noise[sum] > 0 && !(totals[sum] > normal_975 * std::sqrt(sums.noise[sum]));
}

/// What the sum is less than, with 97.5 % confidence, where the reference's noise hides it.
double bound(const ErrorSums& sums, const ErrorTotals& totals, ErrorSum sum) {
    return std::max(0.0, totals[sum]) + normal_975 * std::sqrt(sums.noise[sum]);
}

Measured bounded(double below) { return {not_a_number, not_a_number, below, {}, 1}; }
Measured undefined() { return {not_a_number, not_a_number, {}, {}, 0}; }

Measured root_mean(const ErrorSums& sums, const ErrorTotals& totals, ErrorSum sum, ErrorSum count) {
    if (!(totals[count] > 0)) return undefined();
    if (hidden(sums, totals, sum)) return bounded(std::sqrt(bound(sums, totals, sum) / totals[count]));
    return interval(sums, [=](Totals t) { return std::sqrt(std::max(0.0, t[0][sum]) / t[0][count]); });
}

Measured structure(const ErrorSums& sums, const ErrorTotals& totals) {
    const ErrorSum blocks = ErrorSum::block_mean_square, pixels = ErrorSum::in_blocks_square;
    if (hidden(sums, totals, pixels) || !(totals[pixels] > 0)) return undefined();
    if (hidden(sums, totals, blocks))
        return bounded(std::min(block_size, bound(sums, totals, blocks) / totals[pixels] * block_size));
    return interval(sums, [=](Totals t) {
        return t[0][pixels] > 0 ? std::max(0.0, t[0][blocks]) / t[0][pixels] * block_size : not_a_number;
    });
}

void test_bias(ErrorMeasures& m) {
    const auto count = static_cast<double>(m.sums.seeds.size());
    double means = 0, variances_seeds = 0, scores = 0, scored_tiles = 0;  // scores: sum of m_t^2 / v_t
    for (std::size_t t = 0; t < error_tile_count; ++t) {
        const ErrorTotals& own = m.sums.reference[t];
        const double n = own[ErrorSum::pixels];
        if (!(n > 0)) continue;
        const double reference_variance = own[ErrorSum::luminance_square] / (n * n);
        double mean = 0, squares = 0, spread = 0;
        for (const ErrorTiles& tiles : m.sums.seeds) {
            mean += tiles[t][ErrorSum::luminance] / n / count;
            squares += tiles[t][ErrorSum::luminance_square] / count;
        }
        for (const ErrorTiles& tiles : m.sums.seeds) spread += std::pow(tiles[t][ErrorSum::luminance] / n - mean, 2);
        means += mean * mean;
        const double variance =
            std::max(0.0, squares - own[ErrorSum::luminance_square]) / (n * n * count) + reference_variance;
        if (variance > 0) {
            scores += mean * mean / variance;
            scored_tiles += 1;
        }
        if (count > 1) variances_seeds += spread / (count - 1) / count + reference_variance;
    }
    m.z_pixels = scored_tiles > 0 ? std::sqrt(scores / scored_tiles) : not_a_number;
    if (count > 1 && variances_seeds > 0) m.z_seeds = std::sqrt(means / variances_seeds);
}

}  // namespace

ErrorMeasures measure_errors(std::span<const Image> seeds, const Reference& reference) {
    ErrorMeasures m{};
    m.sums = sum_errors(seeds, reference);
    const ErrorTotals totals = m.sums.totals();
    m.reference_luminance = mean_luminance(reference);
    double reference_square = 0;
    for (const ErrorTotals& t : m.sums.reference) reference_square += t[ErrorSum::square];
    m.reference_rmse = std::sqrt(reference_square / totals[ErrorSum::pixels]);
    m.rmse = root_mean(m.sums, totals, ErrorSum::square, ErrorSum::pixels);
    m.relative_rmse = root_mean(m.sums, totals, ErrorSum::relative_square, ErrorSum::pixels);
    m.block_rmse = root_mean(m.sums, totals, ErrorSum::block_mean_square, ErrorSum::block_pixels);
    m.robust_rmse = m.rmse.resolved() ? median_of_means(m.sums) : m.rmse;
    m.r8 = structure(m.sums, totals);
    m.mean_error = interval(m.sums, [](Totals t) { return t[0][ErrorSum::luminance] / t[0][ErrorSum::pixels]; });
    m.structured_mse = (totals[ErrorSum::block_mean_square] * block_size - totals[ErrorSum::in_blocks_square]) /
                       totals[ErrorSum::block_pixels] / (block_size - 1);
    if (m.rmse.resolved()) m.few_pixels = few_pixels(m.sums);
    test_bias(m);
    return m;
}

RmseRatio rmse_ratio(const ErrorMeasures& row, const ErrorMeasures& baseline) {
    RmseRatio ratio{undefined(), undefined(), {}, false};
    const auto of = [](const Measured& a, const Measured& b) {
        Measured m = undefined();
        if (a.resolved() && b.resolved() && b.value > 0) m.value = a.value / b.value;
        if (a.below && b.resolved() && b.value > 0) m.below = *a.below / b.value;
        if (a.resolved() && b.below) m.above = a.value / *b.below;
        return m;
    };
    ratio.baseline_is_zero = baseline.rmse.value == 0;
    ratio.robust = of(row.robust_rmse, baseline.robust_rmse);
    ratio.value = of(row.rmse, baseline.rmse);
    const bool resolved = ratio.value.resolved();
    if (&row == &baseline) {
        if (resolved) ratio.value.half_width = 0;
        return ratio;
    }
    if (resolved) {
        const std::array<const ErrorSums*, 2> both{&row.sums, &baseline.sums};
        ratio.value = error_interval(both, [](Totals t) {
            return t[1][ErrorSum::square] > 0
                       ? std::sqrt(std::max(0.0, t[0][ErrorSum::square]) / t[1][ErrorSum::square])
                       : not_a_number;
        });
    }
    const std::optional<FewPixels>&a = row.few_pixels, &b = baseline.few_pixels;
    if (a || b)
        ratio.decided_by_pixels = (a && (!b || a->share > b->share) ? a : b)->count;
    else if (resolved && std::fabs(ratio.value.value - 1) > ratio.value.half_width)
        ratio.decided_by_pixels = few_pixels_between(row.sums, baseline.sums);
    if (ratio.decided_by_pixels) ratio.value = undefined();
    return ratio;
}

std::optional<WorstBlock> worst_block(const ErrorMeasures& errors) {
    std::optional<WorstBlock> worst;
    const ErrorSums::Blocks& blocks = errors.sums.blocks;
    for (std::uint32_t b = 0; b < blocks.mean.size(); ++b) {
        const double mean = blocks.mean[b];
        if (worst && !(std::fabs(mean) > std::fabs(worst->mean_error))) continue;
        worst = WorstBlock{b % blocks.columns * error_block, b / blocks.columns * error_block, mean};
    }
    return worst;
}

}  // namespace raycache::tracer
