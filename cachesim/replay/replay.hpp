// Functional replay of one launch on one GPU: which sectors hit where. Order only, no time.
//
// Statistics are kept for batches: the warps from a call of count_from_here() to one of count_until_here(), whenever
// they run. Warps outside batches warm the caches and are not counted. All warps are one batch unless the caller says
// otherwise.
//
// A CTA is Gpu::warps_per_cta consecutive warps of the launch (the last may be shorter). An SM has room for
// floor(warps_per_sm / warps_per_cta) CTAs, at least 1. CTA c starts on SM c mod n while there is room (each SM takes
// one, then the next SM); a later CTA goes to whichever SM frees a slot first. SMs take turns in order of their number,
// one warp access per turn; an SM without unfinished warps is passed over. A slot is free as soon as the last access of
// its CTA is issued, and the next CTA takes it before the next SM's turn; so of two SMs that free a slot in the same
// round, the one whose turn is earlier gets the earlier CTA. Resident warps of an SM take turns too (loose
// round-robin): after warp slot s comes the next unfinished warp in slot order, slot 0 after the last. Warp slot =
// CTA slot * warps_per_cta + place in the CTA; it reads through L1 number (warp slot mod l1_per_sm) of its SM.
// Gpu::scheduler is not asked: "greedy" means as long as a warp is ready, and without time every warp always is, so one
// warp would run to its end before the next begins. A real one stalls at every access.
//
// Where Gpu::simd_width is w < 32, lanes [0, w), [w, 2w), … of a record are a warp access each, in consecutive turns of
// the warp; those without active lanes take no turn.
//
// Ray starts cost no turn. Warps without an access take no turn, CTAs without one no slot. What a warp access misses in
// L1 goes to the next level at once, line by line and with what Fill adds; what misses in the last is read from DRAM.
// The last level is one for all SMs; one in between belongs to an SM.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "cachesim/cache/line_fills.hpp"
#include "cachesim/gpus/gpu.hpp"
#include "cachesim/instruction_set.hpp"
#include "cachesim/replay/request_sink.hpp"
#include "cachesim/replay/statistics.hpp"
#include "traces/header.hpp"
#include "traces/record.hpp"

namespace raycache::cachesim {

class Replay {
public:
    /// Caches start empty. `regions` is copied (without links). Throws Error if the GPU breaks a rule of
    /// cachesim/gpus/limits.hpp or a region is impossible.
    Replay(const Gpu&, const std::vector<traces::Region>& regions, std::uint32_t sample,
           InstructionSet = best_instruction_set());
    ~Replay();
    Replay(Replay&&) noexcept;

    /// The sink, beside others, hears of the caches that it wants. Call before the first push; it must outlive the
    /// replay. Costs nothing where no sink listens, and changes no count where one does.
    void observe(RequestSink&);

    /// Hands over the next warp of the launch, in warp order. Simulates as far as needed to make room for it, so memory
    /// stays bounded by the warps resident at once and what they miss in L1 during a few rounds. Throws Error if a
    /// record contradicts the regions.
    void push(std::shared_ptr<const traces::WarpTrace>);

    /// The warps pushed so far are a kernel, and the next begins when they have ended, on SM 0: L1s empty, what is
    /// below them kept (of a CPU, with three levels, all is kept).
    void end_kernel();

    /// The warps pushed from now on are a batch, the next one. A batch of no warp is none. Caches and SMs stay as they
    /// are: nothing is drained.
    void count_from_here();
    /// The warps pushed from now on are not counted, until the next count_from_here().
    void count_until_here();

    /// Runs what is left and returns the counts of all batches together. Call once.
    LaunchStatistics finish();

    /// The counts of each batch. Complete after finish(): before, of what has run in windows that have ended.
    std::vector<LaunchStatistics> batches() const;

    /// How far the last level is warm: of all its line misses since the launch began, counted in a batch or not, how
    /// many took a way that was still empty, and so would perhaps have hit in a cache that had been running for longer.
    /// Of what has run in windows that have ended.
    LineFills last_level_fills() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace raycache::cachesim
