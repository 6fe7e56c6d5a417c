#include "tracer/quality/error_interval.hpp"

#include <algorithm>
#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>

namespace raycache::tracer {

namespace {

struct Variance {
    double value = 0, degrees = 0;  ///< degrees of freedom; 0: no variance can be told
};

double student(double degrees) { return boost::math::quantile(boost::math::students_t(degrees), 0.975); }

ErrorTotals plus(ErrorTotals a, const ErrorTotals& b, double times) {
    for (std::size_t f = 0; f < error_sum_count; ++f) a.at(f) += times * b.at(f);
    return a;
}

class Jackknife {
public:
    Jackknife(std::span<const ErrorSums* const> strategies, const ErrorFigure& figure)
        : strategies_(strategies), figure_(figure), seeds_(strategies.front()->seeds.size()) {
        for (const ErrorSums* s : strategies) {
            totals_.push_back(s->totals());
            ErrorTiles& mean = tile_means_.emplace_back();
            for (const ErrorTiles& tiles : s->seeds)
                for (std::size_t t = 0; t < error_tile_count; ++t)
                    mean[t] = plus(mean[t], tiles[t], 1 / static_cast<double>(seeds_));
        }
        for (std::size_t t = 0; t < error_tile_count; ++t)
            if (strategies.front()->reference[t][ErrorSum::pixels] > 0) present_.push_back(t);
    }

    double value() const { return figure_(totals_); }

    Variance of_tiles() const {
        const auto n = static_cast<double>(present_.size());
        if (present_.size() < 2) return {};
        std::vector<double> without;
        for (const std::size_t t : present_)
            without.push_back(moved([&](std::size_t s) { return plus(totals_[s], tile_means_[s][t], -1); }));
        double mean = 0, squares = 0, fourths = 0;
        for (const double w : without) mean += w / n;
        for (const double w : without) {
            const double square = (w - mean) * (w - mean);
            squares += square;
            fourths += square * square;
        }
        // As many as there are tiles that matter: a few with all of the error are a small sample.
        const double degrees = fourths > 0 ? std::clamp(squares * squares / fourths, 1.0, n - 1) : n - 1;
        return {(n - 1) / n * squares, degrees};
    }

    Variance of_seeds_in_tiles() const {
        const auto n = static_cast<double>(seeds_);
        Variance sum;
        double squares = 0;
        for (const std::size_t t : present_) {
            std::vector<double> without;
            for (std::size_t r = 0; r < seeds_; ++r)
                without.push_back(moved([&](std::size_t s) { return without_seed(s, r, t); }));
            const double v = (n - 1) / n * squared_spread(without);
            sum.value += v;
            squares += v * v / (n - 1);
        }
        sum.degrees = squares > 0 ? sum.value * sum.value / squares : n - 1;
        return sum;
    }

    Variance of_whole_seeds() const {
        const auto n = static_cast<double>(seeds_);
        std::vector<double> without;
        for (std::size_t r = 0; r < seeds_; ++r)
            without.push_back(moved([&](std::size_t s) {
                ErrorTotals all = totals_[s];
                for (const std::size_t t : present_) all = plus(without_seed(s, r, t), plus(all, totals_[s], -1), 1);
                return all;
            }));
        return {(n - 1) / n * squared_spread(without), n - 1};
    }

    /// Variance that the reference's own error causes, each total moved by its standard deviation.
    double of_reference() const {
        const double centre = value();
        double variance = 0;
        for (std::size_t s = 0; s < strategies_.size(); ++s)
            for (std::size_t f = 0; f < error_sum_count; ++f) {
                const double noise = strategies_[s]->noise.at(f);
                if (noise <= 0) continue;
                std::vector<ErrorTotals> other = totals_;
                other[s].at(f) += std::sqrt(noise);
                const double step = figure_(other) - centre;
                if (std::isfinite(step)) variance += step * step;
            }
        return variance;
    }

private:
    /// The figure with each strategy's totals replaced.
    template <class Replace>
    double moved(const Replace& replace) const {
        std::vector<ErrorTotals> other;
        for (std::size_t s = 0; s < strategies_.size(); ++s) other.push_back(replace(s));
        return figure_(other);
    }
    /// Totals with tile t averaged over all seeds but one.
    ErrorTotals without_seed(std::size_t strategy, std::size_t seed, std::size_t tile) const {
        const auto n = static_cast<double>(seeds_);
        const ErrorTotals &mean = tile_means_[strategy][tile], &one = strategies_[strategy]->seeds[seed][tile];
        return plus(plus(totals_[strategy], mean, 1 / (n - 1)), one, -1 / (n - 1));
    }
    static double squared_spread(const std::vector<double>& values) {
        double mean = 0, squares = 0;
        for (const double v : values) mean += v / static_cast<double>(values.size());
        for (const double v : values) squares += (v - mean) * (v - mean);
        return squares;
    }

    std::span<const ErrorSums* const> strategies_;
    const ErrorFigure& figure_;
    std::size_t seeds_;
    std::vector<ErrorTotals> totals_;
    std::vector<ErrorTiles> tile_means_;
    std::vector<std::size_t> present_;  ///< tiles with pixels
};

Variance of_seeds(const Jackknife& jackknife) {
    const Variance tiles = jackknife.of_seeds_in_tiles(), whole = jackknife.of_whole_seeds();
    if (!(tiles.value > 0) || !std::isfinite(whole.value)) return tiles;
    const double limit = boost::math::quantile(boost::math::fisher_f(whole.degrees, tiles.degrees), 0.95);
    return whole.value > limit * tiles.value ? whole : tiles;
}

}  // namespace

Measured error_interval(std::span<const ErrorSums* const> strategies, const ErrorFigure& figure) {
    const Jackknife jackknife(strategies, figure);
    Measured m{jackknife.value(), not_a_number, {}, {}, 0};
    if (!std::isfinite(m.value)) {
        m.value = not_a_number;
        return m;
    }
    const double noise = jackknife.of_reference();
    const bool one = strategies.front()->seeds.size() == 1;
    const Variance chance = one ? jackknife.of_tiles() : of_seeds(jackknife);
    if (chance.degrees < 1 || !std::isfinite(chance.value)) return m;
    // The spread between tiles has the reference's noise in it; that between seeds has not.
    const double variance = one ? std::max(chance.value, noise) : chance.value + noise;
    m.half_width = student(chance.degrees) * std::sqrt(variance);
    if (variance > 0) m.reference_share = std::min(1.0, noise / variance);
    return m;
}

}  // namespace raycache::tracer
