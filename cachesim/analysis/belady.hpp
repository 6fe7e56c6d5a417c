// Belady's optimum: caches that evict, of a set, the line whose next look-up is the furthest away (Belady 1966, "A
// study of replacement algorithms for a virtual-storage computer"; optimal: Mattson et al. 1970). No policy that takes
// in every line asked for has fewer line misses. Sectors are fetched as ever, so that of sectors, which no known policy
// is optimal for in reasonable time, the figure is that of the fewest line misses, not a proven bound.
//
// The future must be known, so all look-ups are kept until the end: 8 bytes each, charged to the memory that an input
// may take, and simulated then.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "cachesim/analysis/policy_caches.hpp"
#include "cachesim/cache/geometry.hpp"
#include "cachesim/replay/request_sink.hpp"
#include "traces/memory_budget.hpp"

namespace raycache::cachesim {

class BeladyCaches final : public RequestSink {
public:
    /// Listens to all caches of Gpu::levels[level].
    explicit BeladyCaches(std::size_t level) : level_(level) {}

    bool wants(std::size_t level, std::uint32_t /*sm*/) const override { return level == level_; }
    /// Throws MemoryError where the look-ups take more than memory_limit().
    void served(std::size_t level, std::span<const ServedRequest>) override;

    /// What caches of this geometry, whose policy is not asked, count for all look-ups so far.
    PolicyCounts counts(const CacheGeometry&) const;

private:
    struct LookUp {
        std::uint32_t line, asked;
    };
    PolicyCounts counts_of_cache(const CacheGeometry&, const std::vector<LookUp>&) const;

    std::size_t level_;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<LookUp>> look_ups_;  ///< by SM and cache of it
    std::vector<std::uint64_t> addresses_;                                             ///< by line
    MemoryBudget budget_;
};

}  // namespace raycache::cachesim
