// What a timed replay counts: plain numbers, added up by anyone, formatted elsewhere.
#pragma once

#include <array>
#include <cstdint>

#include "cachesim/replay/statistics.hpp"

namespace raycache::cachesim {

/// Answers of one level to sector requests. A request for a sector on its way is a merge: a hit by one convention
/// (functional replays), no hit by the other (GPGPU-Sim: HIT_RESERVED).
struct LevelAnswers {
    std::uint64_t hits = 0;
    std::uint64_t merges = 0;
    std::uint64_t line_misses = 0;    ///< the line was absent
    std::uint64_t sector_misses = 0;  ///< the line was there, the sector was not

    std::uint64_t requests() const { return hits + merges + line_misses + sector_misses; }
    std::uint64_t misses() const { return line_misses + sector_misses; }
    LevelAnswers& operator+=(const LevelAnswers&);
    LevelAnswers& operator-=(const LevelAnswers&);
    bool operator==(const LevelAnswers&) const = default;
};

/// One batch of a launch (timed_replay.hpp): all of it, unless a replay is told otherwise.
struct TimedStatistics {
    std::uint32_t sample = 0;  ///< first sample index of the launch
    std::uint64_t cycles = 0;  ///< of the SM clock; of a whole launch: to the end of the last warp
    double seconds = 0;        ///< cycles / clock
    std::uint64_t rays = 0;
    std::uint64_t warp_accesses = 0, lane_accesses = 0;
    std::uint64_t instructions = 0;                  ///< warp instructions: loads, and those between accesses
    std::uint64_t loads = 0;                         ///< load instructions of warps
    std::array<LevelAnswers, most_levels> levels{};  ///< from L1 down; nothing where there is no such level
    std::uint64_t dram_sectors = 0;

    /// Busy cycles of each resource, summed over its copies, and how many copies there are: utilisation =
    /// busy / (copies * cycles).
    struct Resource {
        double busy = 0;
        std::uint64_t copies = 1;
    };
    Resource issue, l1_port, crossbar, l2_slices, dram;
    Resource l1_tags, l1_data;    ///< parts of what the port does (L1Port::tags)
    Resource l1_mshrs, l2_mshrs;  ///< registers for misses; of L3 where there is one

    /// Of RT units (Traversal::rt_unit): load instructions that no scheduler issues, not among `loads`; the pipelines
    /// of tests; places for warps.
    std::uint64_t rt_loads = 0;
    Resource rt_box_tests, rt_triangle_tests, rt_warps;

    /// From the issue of a visit's first load to its last data, summed over warp accesses.
    std::uint64_t visit_cycles = 0;

    /// Warps with accesses, the cycles that they were resident, summed, and how many can be resident at once. Where
    /// warps fill the slots only once or not even that, cycles are those of the longest warps: no statement on
    /// throughput.
    std::uint64_t warps = 0, warp_cycles = 0, warp_slots = 0;

    double peak_l2_gb_s = 0, peak_dram_gb_s = 0;  ///< of all slices of the last level, of all channels; 10^9 bytes

    /// Of the slots for warps, the share that was taken on average.
    double occupancy() const {
        return cycles && warp_slots
                   ? static_cast<double>(warp_cycles) / static_cast<double>(cycles) / static_cast<double>(warp_slots)
                   : 0;
    }

    /// Launches one after the other on the same GPU.
    TimedStatistics& operator+=(const TimedStatistics&);
    /// What was counted since: of `before`, an earlier state of the same counters. Leaves what is no counter.
    TimedStatistics& operator-=(const TimedStatistics& before);
    /// So many launches like this one: counters rounded to whole numbers.
    TimedStatistics& operator*=(double launches);
};

}  // namespace raycache::cachesim
