#include "cachesim/analysis/estimate.hpp"

#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>
#include <numeric>

namespace raycache::cachesim {

namespace {

double sum(const std::vector<double>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

/// Half width from residuals whose mean square / n is the variance; none if it cannot be told.
std::optional<double> half_width(const std::vector<double>& residuals, double scale) {
    const auto n = static_cast<double>(residuals.size());
    if (residuals.size() < 2 || !std::isfinite(scale)) return std::nullopt;
    double squares = 0;
    for (const double r : residuals) squares += r * r;
    const double width = student_t_975(residuals.size() - 1) * scale * std::sqrt(squares / (n * (n - 1)));
    return std::isfinite(width) ? std::optional(width) : std::nullopt;
}

/// (y_i - R x_i) for all i.
std::vector<double> residuals(const Sums& s, double ratio) {
    std::vector<double> r(s.y.size());
    for (std::size_t i = 0; i < r.size(); ++i) r[i] = s.y[i] - ratio * s.x[i];
    return r;
}

double ratio(double y, double x) { return x > 0 ? y / x : std::numeric_limits<double>::quiet_NaN(); }

}  // namespace

Estimate ratio_of_totals(const Sums& s) {
    const double x = sum(s.x), mean = ratio(sum(s.y), x);
    return {mean, half_width(residuals(s, mean), static_cast<double>(s.x.size()) / x)};
}

Estimate ratio_to_baseline(const Sums& s, const Sums& baseline) {
    const double own = ratio(sum(s.y), sum(s.x)), base = ratio(sum(baseline.y), sum(baseline.x));
    const double mean = ratio(own, base);
    // Q / mean(y) = 1 / (R' mean(x)): finite even where this strategy reads nothing.
    const auto n = static_cast<double>(s.y.size());
    const double own_weight = n / (base * sum(s.x)), base_weight = mean * n / sum(baseline.y);
    std::vector<double> paired = residuals(s, own);
    const std::vector<double> other = residuals(baseline, base);
    for (std::size_t i = 0; i < paired.size(); ++i) paired[i] = own_weight * paired[i] - base_weight * other[i];
    return {mean, half_width(paired, 1)};
}

Estimate product_of_powers(const std::vector<Power>& powers) {
    const std::size_t n = powers.empty() ? 0 : powers.front().values.size();
    double product = 1;
    bool zero = false;
    std::vector<double> residuals(n);
    for (const Power& power : powers) {
        const double total = sum(power.values);
        zero |= total == 0;
        product *= std::pow(total, power.exponent);
        for (std::size_t i = 0; i < n; ++i)
            residuals[i] += power.exponent * (static_cast<double>(n) * power.values[i] / total - 1);
    }
    if (!std::isfinite(product)) return {std::numeric_limits<double>::quiet_NaN(), std::nullopt};
    return {product, zero ? std::nullopt : half_width(residuals, product)};
}

double student_t_975(std::size_t degrees_of_freedom) {
    return boost::math::quantile(boost::math::students_t(static_cast<double>(degrees_of_freedom)), 0.975);
}

double widening(std::size_t degrees_of_freedom, double error) {
    const boost::math::students_t distribution(static_cast<double>(degrees_of_freedom));
    return boost::math::quantile(boost::math::complement(distribution, error / 2)) / student_t_975(degrees_of_freedom);
}

}  // namespace raycache::cachesim
