// What a strategy would have asked of the memory below a level of caches, for every size of these caches, and which
// size another strategy needs to do as well.
//
// The equivalent size of a cache of C bytes with strategy B, for strategy A: the smallest cache with which A fetches no
// more bytes per ray than B does with C (or misses no more often). Its interval is that of a test turned round (Casella
// & Berger, Statistical Inference, 2002, section 9.2.1): all sizes for which the ratio of the two, paired by sample
// index (estimate.hpp), does not differ from 1 at 95 %. No size is guessed between those that exist: a cache has whole
// ways.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cachesim/analysis/estimate.hpp"
#include "cachesim/analysis/lru_surface.hpp"
#include "cachesim/analysis/policy_caches.hpp"
#include "cachesim/cache/geometry.hpp"

namespace raycache::cachesim {

/// All caches of a level with LRU, these sets and any number of ways.
struct CurveRow {
    CacheGeometry geometry;           ///< `ways`: those of the GPU's own cache, where the sets are its own
    std::vector<WaysCurve> launches;  ///< one per sample index

    std::uint64_t way_bytes() const { return geometry.way_bytes(); }
    std::uint64_t most_useful_ways() const;
    /// Of which the curve says anything: 1, or more where it is of a sample.
    std::uint64_t least_ways() const { return launches.empty() ? 1 : launches.front().least_ways(); }
};

/// All caches of a level with the GPU's own sets, another policy, and some numbers of ways.
struct PolicyRow {
    std::string policy;                               ///< one of cache_policies(), or "belady": BeladyCaches
    std::vector<std::uint64_t> ways;                  ///< ascending
    std::vector<std::vector<PolicyCounts>> launches;  ///< one per sample index, each by `ways`
};

/// One level of one strategy.
struct LevelCurve {
    std::size_t level = 0;            ///< 0: L1
    std::vector<double> rays, asked;  ///< by launch; what hit rates are of: of L1 the requests of single loads
    std::vector<CurveRow> rows;       ///< the first is of the GPU's own sets
    std::vector<PolicyRow> policies;  ///< beside lru; those asked for
    std::uint64_t look_ups = 0;

    Sums bytes_per_ray(const CurveRow&, std::uint64_t ways) const;  ///< fetched from below
    Sums misses(const CurveRow&, std::uint64_t ways) const;         ///< per request or sector asked for
    /// The same of another policy, with the ways of policies[].ways[at].
    Sums bytes_per_ray(const PolicyRow&, std::size_t at) const;
    Sums misses(const PolicyRow&, std::size_t at) const;
};

enum class DoesAsWell { bytes_per_ray, misses };

struct EquivalentSize {
    std::uint64_t of = 0;  ///< bytes of the other strategy's cache
    /// Bytes of the base's; none: no size is enough, since what it fetches for the first time alone is more.
    std::optional<std::uint64_t> size;
    /// 95 %; no `low` where there is no interval (one sample index), no `high` where no size is large enough to tell.
    std::optional<std::uint64_t> low, high;

    double times() const { return static_cast<double>(*size) / static_cast<double>(of); }
};

/// Of the GPU's own cache with `other`, for `base`: both are the same level of the same GPU, with the same sample
/// indices.
EquivalentSize equivalent_size(const LevelCurve& base, const LevelCurve& other, DoesAsWell);

/// With the GPU's own cache: bytes per ray of `base` over those of `other`. What the memory below would have to deliver
/// for `base` in the time in which it delivers them for `other`.
Estimate equivalent_bandwidth(const LevelCurve& base, const LevelCurve& other);

}  // namespace raycache::cachesim
