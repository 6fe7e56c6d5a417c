// The RT unit of one SM: which warps it holds, which of them loads next, and when tests are done (RtUnitTiming).
//
// A warp asks for a place when its next visit is to a node or triangle, and gives it back when the SM has something to
// do for it: shading, a texel, or its end. Warps without a place wait in order of asking. Those with one load in the
// order in which they became ready, all loads of a visit one after the other; when the data are there its tests enter
// the pipeline of their kind, in order of that, and the next visit begins when the last result is known. So the lanes
// of a warp step together, as they do in the trace.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include "cachesim/gpus/rt_unit_timing.hpp"
#include "cachesim/replay/timed/cycle.hpp"
#include "cachesim/replay/timed/ring.hpp"

namespace raycache::cachesim {

/// Tests of one kind: a number of them a cycle, whole or not, in order.
class TestPipeline {
public:
    /// `unlimited`: any number in a cycle.
    TestPipeline(double per_cycle, std::uint32_t latency, bool unlimited)
        : per_cycle_(unlimited ? most : std::min(per_cycle, most)),
          full_(std::max<std::uint64_t>(1, static_cast<std::uint64_t>(per_cycle_ * unit))),
          latency_(latency) {}

    /// Tests, at least one, that come in that cycle. Returns when all results are there.
    Cycle run(Cycle time, std::uint32_t tests) {
        if (time > cycle_) {
            cycle_ = time;
            used_ = 0;
        }
        used_ += std::uint64_t{tests} * unit;
        const Cycle last = cycle_ + (used_ - 1) / full_;  // in which they enter
        cycle_ += used_ / full_;
        used_ %= full_;
        tests_ += tests;
        return last + latency_;
    }

    /// Cycles of all tests so far at the full rate.
    double busy() const { return static_cast<double>(tests_) / per_cycle_; }

private:
    static constexpr std::uint64_t unit = 1u << 20;  ///< parts of a test, so that rates need not be whole
    static constexpr double most = 0x1p40;

    double per_cycle_;
    std::uint64_t full_;      ///< parts of a cycle
    std::uint64_t used_ = 0;  ///< of cycle_
    std::uint64_t tests_ = 0;
    Cycle cycle_ = 0;  ///< the first that has something left
    std::uint32_t latency_;
};

class RtUnit {
public:
    /// What the schedulers of an SM know as flights are warps here: each has one visit under way.
    RtUnit(const RtUnitTiming& timing, bool unlimited, std::size_t warps)
        : boxes(timing.box_tests_per_cycle, timing.box_latency, unlimited),
          triangles(timing.triangle_tests_per_cycle, timing.triangle_latency, unlimited),
          free_places_(timing.warps),
          loads_per_cycle_(timing.loads_per_cycle),
          load_queue_(timing.load_queue),
          since_(warps, nowhere) {}

    TestPipeline boxes, triangles;

    // Places in the warp buffer.

    bool holds(std::uint32_t warp) const { return since_[warp] != nowhere; }
    /// The warp, which has no place, is about to visit. Without a free place it waits for one.
    void enter(std::uint32_t warp, Cycle time) {
        if (free_places_ == 0) {
            waiting_.push(warp);
            return;
        }
        --free_places_;
        take_place(warp, time);
    }
    /// The warp, which has a place, goes back to the SM. The one that has waited longest gets it.
    void leave(std::uint32_t warp, Cycle time) {
        place_cycles_ += time - since_[warp];
        since_[warp] = nowhere;
        if (waiting_.empty()) {
            ++free_places_;
            return;
        }
        take_place(waiting_.front(), time);
        waiting_.pop();
    }
    /// Cycles of taken places, summed, up to now.
    Cycle place_cycles(Cycle now) const {
        Cycle all = place_cycles_;
        for (const Cycle since : since_)
            if (since != nowhere) all += now - std::min(now, since);
        return all;
    }

    // Loads.

    /// The warp, which has a place, begins a visit.
    void make_ready(std::uint32_t warp) { ready_.push(warp); }
    bool can_issue() const { return !ready_.empty() && queued_ < load_queue_; }
    std::uint32_t loads_per_cycle() const { return loads_per_cycle_; }
    /// Whose load is next: can_issue().
    std::uint32_t next() const { return ready_.front(); }
    /// It issues; `last`: of its visit.
    void issue_load(bool last) {
        if (last) ready_.pop();
        ++queued_;
        ++loads_;
    }
    /// A load has passed the port.
    void load_passed() { --queued_; }
    std::uint64_t loads() const { return loads_; }

private:
    static constexpr Cycle nowhere = never;

    void take_place(std::uint32_t warp, Cycle time) {
        since_[warp] = time;
        make_ready(warp);
    }

    std::uint32_t free_places_, loads_per_cycle_, load_queue_;
    std::uint32_t queued_ = 0;
    std::uint64_t loads_ = 0;
    Cycle place_cycles_ = 0;
    std::vector<Cycle> since_;  ///< by warp: when it got its place
    Ring<std::uint32_t> waiting_, ready_;
};

}  // namespace raycache::cachesim
