// The terms of the traffic identity, one by one: what each is called, what it is a quotient of, and what a change of it
// means in plain words.
//
//     DRAM bytes/ray = steps/ray x warp accesses/step x sectors/warp access x L1 miss rate x L2 miss rate x sector
//     bytes (L1 miss rate: of visits)
//
// Each quotient's numerator is the next one's denominator, so the product is exact for any counts.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cachesim/analysis/estimate.hpp"
#include "cachesim/replay/statistics.hpp"

namespace raycache::cachesim {

/// DRAM bytes/ray = steps/ray x warp accesses/step x sectors/warp access x L1 miss rate x L2 miss rate x 32 B, with
/// x L3 miss rate where there is an L3, and the GPU's own sector size. A level's miss rate is what it fetches over what
/// it is asked for, of L1 per visit: each distinct sector of a warp access once. Each factor is this strategy's over
/// the baseline's, with its interval, paired by sample index; the product of the means is the ratio of DRAM bytes/ray
/// exactly, computed from totals over all sample indices.
struct Factors {
    Estimate work{1, {}}, simt_efficiency{1, {}}, coalescing{1, {}}, l1_locality{1, {}}, l2_locality{1, {}};
    Estimate l3_locality{1, {}};  ///< 1 where there is no L3
    /// Products of these: all before the caches, the ratio that would remain with equal miss rates; all miss rates; and
    /// those of L1 and L2.
    Estimate equal_miss_rates{1, {}}, cache_locality{1, {}}, l1_l2_locality{1, {}};

    double product() const {
        return work.mean * simt_efficiency.mean * coalescing.mean * l1_locality.mean * l2_locality.mean *
               l3_locality.mean;
    }
};

struct FactorTerm {
    const char *name, *key;  ///< "SIMT efficiency", "simt_efficiency"
    const char* quantity;    ///< "warp accesses/step"
    std::uint64_t Counters::*numerator, Counters::*denominator;
    Estimate Factors::*factor;
    const char *fewer, *more;  ///< what a factor below, or above, 1 says

    /// NaN or infinite where the denominator is 0.
    double value(const Counters& c) const {
        return static_cast<double>(c.*numerator) / static_cast<double>(c.*denominator);
    }
};

/// In the order of the identity, for a GPU with so many levels of caches: 2 or 3.
std::span<const FactorTerm> factor_terms(std::size_t levels);

/// Each term of `other` over that of `base`, both by sample index, in the same order; none where a quotient has no
/// value.
std::optional<Factors> traffic_factors(const std::vector<Counters>& base, const std::vector<Counters>& other,
                                       std::size_t levels);

/// What moves between two levels, or is read from DRAM.
enum class Traffic { l2_to_l1, l3_to_l2, dram };

/// What does most for the ratio of this traffic: of the factors that change it in its own direction, the one furthest
/// from 1 on a logarithmic scale. The miss rates of all levels above the traffic count as one factor, cache locality:
/// L2 is asked only for what L1 lacks, so each of them alone says little (docs/explain.md).
struct MainCause {
    std::string name;  ///< "SIMT efficiency", "cache locality"
    Estimate factor;
    std::string meaning;  ///< "fewer warp accesses per step: less divergence"
};
/// None where the ratio is 1, 0 or no number.
std::optional<MainCause> main_cause(const Factors&, Traffic);

}  // namespace raycache::cachesim
