// One whole launch in time, cut where its SMs become full and where its CTAs run out.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "cachesim/gpus/gpu.hpp"
#include "cachesim/replay/timed/timed_replay.hpp"
#include "traces/header.hpp"
#include "traces/record.hpp"

namespace raycache::cachesim {

/// Cycles and warp accesses of a launch (or of several, added up), stage by stage: together they are those of the whole
/// launch exactly. A CTA without accesses takes no slot, and ends no stage.
struct LaunchStages {
    struct Stage {
        std::uint64_t cycles = 0, warp_accesses = 0;

        bool operator==(const Stage&) const = default;
    };
    std::uint32_t sample = 0;  ///< first sample index of the launch
    /// From the launch, whose own cost (Timing::launch_cycles) is part of it, until the first CTA that found no free
    /// slot becomes resident. Warps begin all at once, with nothing in the caches. Of a launch whose CTAs all find a
    /// slot: until the last of them is resident.
    Stage filling;
    /// From then on until the last CTA becomes resident: all slots are taken. Nothing where no CTA has to wait, or only
    /// the last one.
    Stage full;
    /// From then on until the last warp has ended: slots become free, and nothing takes them.
    Stage draining;

    /// Of the whole launch.
    Stage all() const;
    LaunchStages& operator+=(const LaunchStages&);
    bool operator==(const LaunchStages&) const = default;
};

/// A timed replay of one launch of a megakernel, from cold caches, that says so.
class StagedReplay {
public:
    /// Throws Error as TimedReplay does.
    StagedReplay(const Gpu&, const std::vector<traces::Region>& regions, std::uint32_t sample);

    /// Hands over the next warp of the launch, in warp order. It is replayed when a later CTA has accesses.
    void push(std::shared_ptr<const traces::WarpTrace>);

    /// No more warps: runs to the end. Call once.
    LaunchStages finish();

private:
    using Warps = std::vector<std::shared_ptr<const traces::WarpTrace>>;
    void take_cta();
    void replay_held();

    TimedReplay replay_;
    std::uint32_t sample_, warps_per_cta_;
    std::uint64_t first_waiting_;  ///< number, among CTAs with accesses, of the first that finds no slot
    std::uint64_t working_ = 0;    ///< CTAs with accesses so far
    Warps cta_;                    ///< that is not whole yet
    Warps held_;                   ///< whole CTAs, from the last one with accesses on
    bool held_waits_ = false;      ///< it is the first that finds no slot
    bool becomes_full_ = false;    ///< a CTA behind that one was replayed
};

}  // namespace raycache::cachesim
