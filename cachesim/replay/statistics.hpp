// What a replay counts: plain numbers, added up by anyone, formatted elsewhere (cachesim/report).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "traces/header.hpp"
#include "traces/record.hpp"

namespace raycache::cachesim {

/// Counts of one group of accesses. Every hit rate and every factor of the explanation is a ratio of these.
struct Counters {
    std::uint64_t rays = 0;           ///< ray starts, one per lane (0 in groups split by object kind)
    std::uint64_t steps = 0;          ///< lane accesses to nodes and triangles
    std::uint64_t lane_accesses = 0;  ///< lane accesses to anything
    std::uint64_t warp_accesses = 0;  ///< access records; of a narrower machine: vectors
    std::uint64_t loads = 0;          ///< load instructions that the warp accesses are: LoadCounter
    std::uint64_t l1_requests = 0;    ///< sectors that these ask the tag stage for: what Nsight Compute counts
    std::uint64_t sectors = 0;        ///< distinct sectors of each warp access: those looked up in L1
    std::uint64_t l1_hits = 0;        ///< of those, found (a sector on its way counts as found)
    /// Sectors asked of L2: those missing in L1, and those fetched beside them where the L1 fills more than a sector.
    std::uint64_t l2_sectors = 0;
    std::uint64_t l2_hits = 0;
    std::uint64_t l3_sectors = 0;  ///< sectors asked of L3, likewise; 0 where there is none
    std::uint64_t l3_hits = 0;
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
    std::uint64_t l1_request_hits() const { return l1_requests - (sectors - l1_hits); }

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
