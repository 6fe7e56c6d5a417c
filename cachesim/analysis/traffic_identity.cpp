#include "cachesim/analysis/traffic_identity.hpp"

#include <algorithm>
#include <cmath>

namespace raycache::cachesim {

namespace {

double sign_of(double log) { return log < 0 ? -1 : 1; }

}  // namespace

double Factors::product() const {
    double product = 1;
    for (const Estimate& term : terms) product *= term.mean;
    return product;
}

void Factors::widen(double times) {
    for (Estimate& term : terms) term = widened(term, times);
    equal_miss_rates = widened(equal_miss_rates, times);
    for (Estimate& level : locality) level = widened(level, times);
}

Sums sums_of(const std::vector<Counters>& counts, const Count& numerator, const Count& denominator,
             const CacheUnits& units) {
    Sums sums;
    for (const Counters& c : counts) {
        sums.y.push_back(static_cast<double>(numerator(c, units)));
        sums.x.push_back(static_cast<double>(denominator(c, units)));
    }
    return sums;
}

std::optional<Factors> traffic_factors(const std::vector<Counters>& base, const std::vector<Counters>& other,
                                       const CacheUnits& units) {
    const auto factor = [&](const Count& y, const Count& x) {
        return ratio_to_baseline(sums_of(other, y, x, units), sums_of(base, y, x, units));
    };
    Factors factors;
    for (const IdentityTerm& term : identity_terms(units.levels))
        factors.terms.push_back(factor(term.numerator, term.denominator));
    if (!std::isfinite(factors.product())) return std::nullopt;
    const Count& asked = traffic_identity[terms_before_caches].denominator;
    factors.equal_miss_rates = factor(asked, traffic_identity[0].denominator);
    for (std::size_t level = 0; level < units.levels; ++level)
        factors.locality.push_back(factor(traffic_identity[terms_before_caches + level].numerator, asked));
    return factors;
}

std::optional<MainCause> main_cause(const Factors& factors, std::size_t level) {
    struct Cause {
        const char* name;
        const Estimate* factor;
        const char *fewer, *more;
    };
    std::vector<Cause> causes;
    for (std::size_t i = 0; i < terms_before_caches; ++i)
        causes.push_back(
            {traffic_identity[i].name, &factors.terms[i], traffic_identity[i].fewer, traffic_identity[i].more});
    const IdentityTerm& l1 = traffic_identity[terms_before_caches];
    if (level == 0)
        causes.push_back({l1.name, &factors.locality[0], l1.fewer, l1.more});
    else
        causes.push_back({"cache locality", &factors.locality[level],
                          "fewer misses per sector asked for, all levels together",
                          "more misses per sector asked for, all levels together"});
    double whole = 0;
    for (const Cause& cause : causes) whole += std::log(cause.factor->mean);
    if (!std::isfinite(whole) || whole == 0) return std::nullopt;
    const auto way = [&](const Cause& cause) { return sign_of(whole) * std::log(cause.factor->mean); };
    const Cause& most = *std::max_element(causes.begin(), causes.end(),
                                          [&](const Cause& a, const Cause& b) { return way(a) < way(b); });
    return MainCause{most.name, *most.factor, most.factor->mean < 1 ? most.fewer : most.more};
}

}  // namespace raycache::cachesim
