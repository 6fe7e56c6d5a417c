// The terms of the traffic identity, one by one: what each is called, what it is a quotient of, and what a change of it
// means in plain words.
//
//     DRAM bytes/ray = steps/ray x warp accesses/step x sectors/warp access x L1 miss rate x L2 miss rate x sector
//     bytes
//
// Each quotient's numerator is the next one's denominator, so the product is exact for any counts.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "cachesim/replay/statistics.hpp"
#include "cachesim/report/report.hpp"

namespace raycache::cachesim {

struct FactorTerm {
    const char *name, *key;  ///< "SIMT efficiency", "simt_efficiency"
    const char* quantity;    ///< "warp accesses/step"
    std::uint64_t Counters::*numerator, Counters::*denominator;
    double Factors::*factor;
    const char *fewer, *more;  ///< what a factor below, or above, 1 says

    /// NaN or infinite where the denominator is 0.
    double value(const Counters& c) const {
        return static_cast<double>(c.*numerator) / static_cast<double>(c.*denominator);
    }
};

/// In the order of the identity, for a GPU with so many levels of caches: 2 or 3.
std::span<const FactorTerm> factor_terms(std::size_t levels);

/// Each term of `other` over that of `base`; none where a quotient has no value.
std::optional<Factors> traffic_factors(const Counters& base, const Counters& other, std::size_t levels);

/// The term that does most for the ratio: of those that change the traffic in the direction of the product, the one
/// furthest from 1.
struct MainTerm {
    const FactorTerm* term;
    double factor;
    double share;  ///< log(factor) / log(product); above 1 where other terms work against it
    const char* meaning() const { return factor < 1 ? term->fewer : term->more; }
};
/// None where the product is 1, 0 or no number.
std::optional<MainTerm> main_term(const Factors&);

}  // namespace raycache::cachesim
