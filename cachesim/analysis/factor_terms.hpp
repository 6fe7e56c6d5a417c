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

#include "cachesim/replay/statistics.hpp"
#include "cachesim/report/report.hpp"

namespace raycache::cachesim {

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
