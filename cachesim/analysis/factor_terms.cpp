#include "cachesim/analysis/factor_terms.hpp"

#include <array>
#include <cmath>

namespace raycache::cachesim {

namespace {

constexpr FactorTerm work{"work",          "work",         "steps/ray",           &Counters::steps,
                          &Counters::rays, &Factors::work, "fewer steps per ray", "more steps per ray"};
constexpr FactorTerm simt{"SIMT efficiency",
                          "simt_efficiency",
                          "warp accesses/step",
                          &Counters::warp_accesses,
                          &Counters::steps,
                          &Factors::simt_efficiency,
                          "fewer warp accesses per step: less divergence",
                          "more warp accesses per step: more divergence"};
constexpr FactorTerm coalescing{"coalescing",
                                "coalescing",
                                "sectors/warp access",
                                &Counters::sectors,
                                &Counters::warp_accesses,
                                &Factors::coalescing,
                                "fewer sectors per warp access: lanes share more of them",
                                "more sectors per warp access: lanes share fewer of them"};
constexpr FactorTerm l1{"L1 locality",      "l1_locality",         "L1 miss rate",       &Counters::l2_sectors,
                        &Counters::sectors, &Factors::l1_locality, "lower L1 miss rate", "higher L1 miss rate"};

constexpr FactorTerm l2(std::uint64_t Counters::*fetched) {
    return {"L2 locality",         "l2_locality",         "L2 miss rate",       fetched,
            &Counters::l2_sectors, &Factors::l2_locality, "lower L2 miss rate", "higher L2 miss rate"};
}
constexpr FactorTerm l3{"L3 locality",         "l3_locality",         "L3 miss rate",       &Counters::dram_sectors,
                        &Counters::l3_sectors, &Factors::l3_locality, "lower L3 miss rate", "higher L3 miss rate"};

constexpr std::array two_levels{work, simt, coalescing, l1, l2(&Counters::dram_sectors)};
constexpr std::array three_levels{work, simt, coalescing, l1, l2(&Counters::l3_sectors), l3};

}  // namespace

std::span<const FactorTerm> factor_terms(std::size_t levels) {
    return levels == 3 ? std::span<const FactorTerm>(three_levels) : two_levels;
}

std::optional<Factors> traffic_factors(const Counters& base, const Counters& other, std::size_t levels) {
    Factors factors;
    for (const FactorTerm& term : factor_terms(levels)) factors.*term.factor = term.value(other) / term.value(base);
    return std::isfinite(factors.product()) ? std::optional(factors) : std::nullopt;
}

std::optional<MainTerm> main_term(const Factors& factors) {
    const double whole = std::log(factors.product());
    if (!std::isfinite(whole) || whole == 0) return std::nullopt;
    std::optional<MainTerm> best;
    for (const FactorTerm& term : three_levels) {  // a factor of 1 where there is no L3 is never the best
        const double factor = factors.*term.factor, share = std::log(factor) / whole;
        if (!best || share > best->share) best = MainTerm{&term, factor, share};
    }
    return best;
}

}  // namespace raycache::cachesim
