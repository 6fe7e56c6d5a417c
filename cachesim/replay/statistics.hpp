// What a replay counts: plain numbers, added up by anyone, formatted elsewhere (cachesim/report).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "traces/header.hpp"
#include "traces/record.hpp"

namespace raycache::cachesim {

/// Most levels of caches that a GPU has.
inline constexpr std::size_t most_levels = 3;

/// What the caches of one level are asked for.
struct LevelCounts {
    /// Sectors. Of L1: the distinct ones of each warp access. Of a level below: those missing in the level above, and
    /// those fetched beside them where that level fills more than a sector.
    std::uint64_t sectors = 0;
    std::uint64_t hits = 0;  ///< of those, found (a sector on its way counts as found)

    bool operator==(const LevelCounts&) const = default;
};

/// Counts of one group of accesses. Every figure of a report is a quotient of these (cachesim/analysis/counts.hpp).
struct Counters {
    std::uint64_t rays = 0;           ///< ray starts, one per lane (0 in groups split by object kind)
    std::uint64_t steps = 0;          ///< lane accesses to nodes and triangles
    std::uint64_t lane_accesses = 0;  ///< lane accesses to anything
    std::uint64_t warp_accesses = 0;  ///< access records; of a narrower machine: vectors
    std::uint64_t loads = 0;          ///< load instructions that the warp accesses are: LoadCounter
    std::uint64_t requests = 0;       ///< sectors that these ask L1's tag stage for: what Nsight Compute counts
    std::array<LevelCounts, most_levels> levels{};  ///< from L1 down; nothing where there is no such level
    /// Sectors read from DRAM, those fetched beside the missing ones included. Of a wavefront also those written to it,
    /// and those that sorts read and write.
    std::uint64_t dram_sectors = 0;
    std::uint64_t written_sectors = 0, sort_sectors = 0;  ///< of these
    /// Of dram_sectors, those read that were in no cache before in this launch: compulsory misses of the GPU, which no
    /// cache avoids. Each launch begins with cold caches.
    std::uint64_t dram_first_sectors = 0;

    /// Sectors read from DRAM: neither written nor moved by sorts.
    std::uint64_t dram_read_sectors() const { return dram_sectors - written_sectors - sort_sectors; }

    /// Requests of single loads that L1 answers: only the first request for a sector in a warp access can miss.
    std::uint64_t request_hits() const { return requests - (levels[0].sectors - levels[0].hits); }

    /// Sectors that level `level`, from 0, of `count` levels fetches from what is below it.
    std::uint64_t fetched(std::size_t level, std::size_t count) const {
        return level + 1 < count ? levels[level + 1].sectors : dram_sectors;
    }

    Counters& operator+=(const Counters&);
    bool operator==(const Counters&) const = default;
};

/// Counters of one ray type and bounce, split by kind of object. `rays` stands in `all` only.
struct RayGroup {
    traces::RayType ray = traces::RayType::camera;
    std::uint8_t bounce = 0;
    std::array<Counters, traces::object_kinds> by_kind{};  ///< index: traces::ObjectKind
    std::uint64_t rays = 0;

    Counters all() const;
    bool operator==(const RayGroup&) const = default;
};

/// One batch of warps of a launch on one GPU: all of them, unless a replay is told otherwise (replay.hpp). Caches are
/// empty when the launch begins.
struct LaunchStatistics {
    std::uint32_t sample = 0;      ///< first sample index of the launch
    std::vector<RayGroup> groups;  ///< by ray type, then bounce; only those that occur

    Counters all() const;
    bool operator==(const LaunchStatistics&) const = default;
};

}  // namespace raycache::cachesim
