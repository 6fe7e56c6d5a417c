// The counts that figures are quotients of, by name: functions of what a replay counted, so that an estimator can take
// them launch by launch. All of them are sums: of launches, and of groups of accesses within one.
#pragma once

#include <cstddef>
#include <cstdint>

#include "cachesim/replay/statistics.hpp"

namespace raycache::cachesim {

/// What of a GPU's caches turns counts into figures.
struct CacheUnits {
    std::size_t levels = 2;           ///< of caches: 2 or 3
    std::uint32_t sector_bytes = 32;  ///< turns sectors into bytes
};

/// A count with the name that formulas give it.
template <class Statistics, class Number>
struct Quantity {
    const char* name;
    Number (*of)(const Statistics&, const CacheUnits&);

    Number operator()(const Statistics& statistics, const CacheUnits& units) const { return of(statistics, units); }
};

/// Of a functional replay.
using Count = Quantity<Counters, std::uint64_t>;

namespace counts {

using Units = CacheUnits;

inline constexpr Count rays{"rays", [](const Counters& c, const Units&) { return c.rays; }};
inline constexpr Count steps{"steps", [](const Counters& c, const Units&) { return c.steps; }};
inline constexpr Count lane_accesses{"lane_accesses", [](const Counters& c, const Units&) { return c.lane_accesses; }};
inline constexpr Count warp_accesses{"warp_accesses", [](const Counters& c, const Units&) { return c.warp_accesses; }};
inline constexpr Count loads{"loads", [](const Counters& c, const Units&) { return c.loads; }};
inline constexpr Count requests{"l1_requests", [](const Counters& c, const Units&) { return c.requests; }};
inline constexpr Count request_hits{"l1_hits", [](const Counters& c, const Units&) { return c.request_hits(); }};

inline constexpr const char* names_of_asked[most_levels] = {"sectors", "l2_sectors", "l3_sectors"};
inline constexpr const char* names_of_hits[most_levels] = {"l1_visit_hits", "l2_hits", "l3_hits"};
inline constexpr const char* names_of_fetched[most_levels] = {"l1_misses", "l2_misses", "l3_misses"};
inline constexpr const char* names_of_bytes[most_levels] = {"l1_bytes", "l2_bytes", "l3_bytes"};

/// Sectors asked of level `level`, from 0; those it has; those it fetches from below.
template <std::size_t level>
inline constexpr Count asked{names_of_asked[level],
                             [](const Counters& c, const Units&) { return c.levels[level].sectors; }};
template <std::size_t level>
inline constexpr Count hits{names_of_hits[level], [](const Counters& c, const Units&) { return c.levels[level].hits; }};
template <std::size_t level>
inline constexpr Count fetched{names_of_fetched[level],
                               [](const Counters& c, const Units& u) { return c.fetched(level, u.levels); }};
/// Bytes asked of it.
template <std::size_t level>
inline constexpr Count asked_bytes{
    names_of_bytes[level], [](const Counters& c, const Units& u) { return c.levels[level].sectors * u.sector_bytes; }};

inline constexpr Count dram_sectors{"dram_sectors", [](const Counters& c, const Units&) { return c.dram_sectors; }};
inline constexpr Count dram_read_sectors{"dram_read_sectors",
                                         [](const Counters& c, const Units&) { return c.dram_read_sectors(); }};
inline constexpr Count dram_first_sectors{"dram_first_sectors",
                                          [](const Counters& c, const Units&) { return c.dram_first_sectors; }};
inline constexpr Count written_sectors{"written_sectors",
                                       [](const Counters& c, const Units&) { return c.written_sectors; }};
inline constexpr Count sort_sectors{"sort_sectors", [](const Counters& c, const Units&) { return c.sort_sectors; }};
inline constexpr Count dram_bytes{"dram_bytes",
                                  [](const Counters& c, const Units& u) { return c.dram_sectors * u.sector_bytes; }};
inline constexpr Count written_bytes{
    "written_bytes", [](const Counters& c, const Units& u) { return c.written_sectors * u.sector_bytes; }};
inline constexpr Count sort_bytes{"sort_bytes",
                                  [](const Counters& c, const Units& u) { return c.sort_sectors * u.sector_bytes; }};

}  // namespace counts

}  // namespace raycache::cachesim
