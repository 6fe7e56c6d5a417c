#include "cachesim/analysis/factor_terms.hpp"

#include <cmath>

namespace raycache::cachesim {

std::optional<Factors> traffic_factors(const Counters& base, const Counters& other) {
    Factors factors;
    for (const FactorTerm& term : factor_terms) factors.*term.factor = term.value(other) / term.value(base);
    return std::isfinite(factors.product()) ? std::optional(factors) : std::nullopt;
}

std::optional<MainTerm> main_term(const Factors& factors) {
    const double whole = std::log(factors.product());
    if (!std::isfinite(whole) || whole == 0) return std::nullopt;
    std::optional<MainTerm> best;
    for (const FactorTerm& term : factor_terms) {
        const double factor = factors.*term.factor, share = std::log(factor) / whole;
        if (!best || share > best->share) best = MainTerm{&term, factor, share};
    }
    return best;
}

}  // namespace raycache::cachesim
