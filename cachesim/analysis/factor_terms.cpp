#include "cachesim/analysis/factor_terms.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "cachesim/analysis/estimate.hpp"

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
constexpr FactorTerm l1{
    "L1 locality",      "l1_locality",         "L1 visit miss rate",           &Counters::l2_sectors,
    &Counters::sectors, &Factors::l1_locality, "lower L1 miss rate of visits", "higher L1 miss rate of visits"};

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

namespace {

/// (y/x of other) / (y/x of base).
Estimate factor(const std::vector<Counters>& base, const std::vector<Counters>& other, std::uint64_t Counters::*y,
                std::uint64_t Counters::*x) {
    const auto values = [](const std::vector<Counters>& counts, std::uint64_t Counters::*member) {
        std::vector<double> all;
        for (const Counters& c : counts) all.push_back(static_cast<double>(c.*member));
        return all;
    };
    return ratio_to_baseline({values(other, y), values(other, x)}, {values(base, y), values(base, x)});
}

double sign_of(double log) { return log < 0 ? -1 : 1; }

}  // namespace

std::optional<Factors> traffic_factors(const std::vector<Counters>& base, const std::vector<Counters>& other,
                                       std::size_t levels) {
    Factors factors;
    for (const FactorTerm& term : factor_terms(levels))
        factors.*term.factor = factor(base, other, term.numerator, term.denominator);
    if (!std::isfinite(factors.product())) return std::nullopt;
    factors.equal_miss_rates = factor(base, other, &Counters::sectors, &Counters::rays);
    factors.cache_locality = factor(base, other, &Counters::dram_sectors, &Counters::sectors);
    factors.l1_l2_locality =
        levels == 3 ? factor(base, other, &Counters::l3_sectors, &Counters::sectors) : factors.cache_locality;
    return factors;
}

std::optional<MainCause> main_cause(const Factors& factors, Traffic traffic) {
    struct Cause {
        const char* name;
        const Estimate* factor;
        const char *fewer, *more;
    };
    std::vector<Cause> causes;
    for (const FactorTerm& term : {work, simt, coalescing})
        causes.push_back({term.name, &(factors.*term.factor), term.fewer, term.more});
    if (traffic == Traffic::l2_to_l1)
        causes.push_back({l1.name, &factors.l1_locality, l1.fewer, l1.more});
    else
        causes.push_back({"cache locality",
                          traffic == Traffic::dram ? &factors.cache_locality : &factors.l1_l2_locality,
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
