// The traffic identity: what DRAM bytes per ray are the product of, term by term.
//
//     DRAM bytes/ray = steps/ray x warp accesses/step x sectors/warp access x L1 miss rate x L2 miss rate x sector
//     bytes, with x L3 miss rate where there is an L3
//
// A level's miss rate is what it fetches over what it is asked for, of L1 per visit: each distinct sector of a warp
// access once. Each term's numerator is the next one's denominator, so the product is exact for any counts.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cachesim/analysis/counts.hpp"
#include "cachesim/analysis/estimate.hpp"

namespace raycache::cachesim {

struct IdentityTerm {
    const char *key, *name;  ///< "simt_efficiency", "SIMT efficiency"
    const char* quantity;    ///< "warp accesses/step"
    Count numerator, denominator;
    const char *fewer, *more;  ///< what a factor below, or above, 1 says

    /// NaN or infinite where the denominator is 0.
    double value(const Counters& c, const CacheUnits& units) const {
        return static_cast<double>(numerator(c, units)) / static_cast<double>(denominator(c, units));
    }
};

/// Terms before those of the caches.
inline constexpr std::size_t terms_before_caches = 3;

inline constexpr IdentityTerm traffic_identity[terms_before_caches + most_levels] = {
    {"work", "work", "steps/ray", counts::steps, counts::rays, "fewer steps per ray", "more steps per ray"},
    {"simt_efficiency", "SIMT efficiency", "warp accesses/step", counts::warp_accesses, counts::steps,
     "fewer warp accesses per step: less divergence", "more warp accesses per step: more divergence"},
    {"coalescing", "coalescing", "sectors/warp access", counts::asked<0>, counts::warp_accesses,
     "fewer sectors per warp access: lanes share more of them",
     "more sectors per warp access: lanes share fewer of them"},
    {"l1_locality", "L1 locality", "L1 visit miss rate", counts::fetched<0>, counts::asked<0>,
     "lower L1 miss rate of visits", "higher L1 miss rate of visits"},
    {"l2_locality", "L2 locality", "L2 miss rate", counts::fetched<1>, counts::asked<1>, "lower L2 miss rate",
     "higher L2 miss rate"},
    {"l3_locality", "L3 locality", "L3 miss rate", counts::fetched<2>, counts::asked<2>, "lower L3 miss rate",
     "higher L3 miss rate"},
};

/// The terms for a GPU with that number of cache levels, in the order of the identity.
inline std::span<const IdentityTerm> identity_terms(std::size_t levels) {
    return std::span(traffic_identity).first(terms_before_caches + levels);
}

/// Each term of one trace over that of another, paired by sample index. The product of the means is the ratio of DRAM
/// bytes/ray exactly, computed from totals over all sample indices.
struct Factors {
    std::vector<Estimate> terms;  ///< of identity_terms()
    /// All terms before the caches together: the ratio that would remain with equal miss rates.
    Estimate equal_miss_rates{1, {}};
    /// By level of cache: the miss rates of all levels down to this one together. The last is that of all caches.
    std::vector<Estimate> locality;

    const Estimate& cache_locality() const { return locality.back(); }
    double product() const;
    /// Multiplies the width of all intervals.
    void widen(double times);
};

/// What the estimators of a quotient of counts take, from one Counters for each sample index.
Sums sums_of(const std::vector<Counters>&, const Count& numerator, const Count& denominator, const CacheUnits&);

/// The terms of `other` over those of `base`, both by sample index, in the same order; none where a quotient has no
/// value.
std::optional<Factors> traffic_factors(const std::vector<Counters>& base, const std::vector<Counters>& other,
                                       const CacheUnits&);

/// What does most for the ratio of the traffic below level `level`, from 0: of the factors that change it in its own
/// direction, the one furthest from 1 on a logarithmic scale. The miss rates of all levels above the traffic count as
/// one factor, cache locality: L2 is asked only for what L1 lacks, so each of them alone says little (docs/explain.md).
struct MainCause {
    std::string name;  ///< "SIMT efficiency", "cache locality"
    Estimate factor;
    std::string meaning;  ///< "fewer warp accesses per step: less divergence"
};
/// None where the ratio is 1, 0 or no number.
std::optional<MainCause> main_cause(const Factors&, std::size_t level);

}  // namespace raycache::cachesim
