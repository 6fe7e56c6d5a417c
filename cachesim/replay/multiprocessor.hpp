// One SM: its resident CTAs and whose turn it is. After slot s the next unfinished resident warp in slot order has its
// turn, slot 0 following the last. A machine of fewer lanes than a warp runs each record as several vectors,
// neighbouring lanes together: those without active lanes take no turn, each other takes one.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "cachesim/replay/group_numbers.hpp"
#include "cachesim/replay/sm_caches.hpp"
#include "cachesim/replay/vectors.hpp"
#include "traces/record.hpp"

namespace raycache::cachesim {

using WarpPointer = std::shared_ptr<const traces::WarpTrace>;

/// A warp of a launch, and the batch that it is counted in.
struct PushedWarp {
    WarpPointer trace;
    BatchGroups* groups = nullptr;
};

class Multiprocessor {
public:
    /// Warp slot s (CTA slot * warps_per_cta + place in the CTA) reads through L1 s mod l1_per_sm of the SM, whose
    /// caches must outlive this object.
    Multiprocessor(unsigned cta_slots, const Gpu& gpu, SmCaches& memory)
        : memory_(memory),
          warps_per_cta_(gpu.warps_per_cta),
          l1_per_sm_(gpu.l1_per_sm),
          simd_width_(gpu.simd_width),
          traces_(std::size_t{cta_slots} * warps_per_cta_),
          unfinished_(cta_slots) {}

    bool idle() const { return active_.empty(); }

    /// Makes the warps resident, all before their first record; those without an access end here.
    void place(unsigned cta_slot, std::span<const PushedWarp> warps, Workspace& work) {
        auto at = active_.begin();
        while (at != active_.end() && at->slot < cta_slot * warps_per_cta_) ++at;
        auto place = static_cast<std::size_t>(at - active_.begin());
        for (std::size_t i = 0; i < warps.size(); ++i) {
            const traces::WarpTrace& trace = *warps[i].trace;
            Warp warp;
            warp.slot = cta_slot * warps_per_cta_ + static_cast<unsigned>(i);
            warp.l1 = warp.slot % l1_per_sm_;
            warp.number = trace.warp;
            warp.groups = warps[i].groups;
            warp.next = trace.records.data();
            warp.end = warp.next + trace.records.size();
            warp.elements = trace.elements.data();
            if (!advance_to_access(warp, work)) continue;
            traces_[warp.slot] = warps[i].trace;
            if (place < turn_ || (place == turn_ && warp.slot < resume_slot_)) ++turn_;
            active_.insert(active_.begin() + static_cast<std::ptrdiff_t>(place), warp);
            ++place;
            ++unfinished_[cta_slot];
        }
    }

    /// Brings near what the warps read first when they run on.
    void prefetch() const {
        for (const Warp& warp : active_) {
            __builtin_prefetch(warp.next);
            __builtin_prefetch(warp.next + 8);
            for (unsigned lane = 0; lane < 2 * traces::warp_lanes; lane += 16) __builtin_prefetch(warp.elements + lane);
        }
    }

    /// Takes its turn in each round from `round` up to `end`, and counts `round` up. Stops after an access that frees a
    /// CTA slot, and returns that slot. SmCaches::end_run(), and then forget_ended(), may come when it returns or later.
    std::optional<unsigned> run(std::size_t& round, std::size_t end, Workspace& work) {
        unsigned freed = none;
        while (round < end && !active_.empty() && freed == none) freed = issue(round++, work);
        if (freed != none) return freed;
        round = end;
        return std::nullopt;
    }

    /// Lets go of the warps that have ended: nothing of theirs is to be looked up any more.
    void forget_ended() { ended_.clear(); }

private:
    struct Warp {
        const traces::Record *next = nullptr, *end = nullptr;
        const std::uint32_t* elements = nullptr;  ///< of `next`, from the first lane left on
        std::uint32_t left = 0;                   ///< lanes of `next` that have not had their turn
        unsigned slot = 0;
        unsigned l1 = 0;
        std::uint32_t number = 0;  ///< of the warp in its launch
        BatchGroups* groups = nullptr;
    };

    static constexpr unsigned none = ~0u;

    /// One warp access of the warp whose turn it is. Returns the CTA slot that it freed, or `none`.
    [[gnu::always_inline]] unsigned issue(std::size_t round, Workspace& work) {
        if (turn_ >= active_.size()) turn_ = 0;
        Warp& warp = active_[turn_];
        // What the warp reads a few turns on.
        __builtin_prefetch(warp.elements + 2 * traces::warp_lanes);
        __builtin_prefetch(warp.elements + 2 * traces::warp_lanes + 16);
        __builtin_prefetch(warp.next + 16);
        traces::Record record = *warp.next;
        record.mask = first_vector(warp.left, simd_width_);
        warp.left &= ~record.mask;
        if (!warp.left) ++warp.next;
        memory_.access(record, warp.elements, warp.number, warp.l1, round, *warp.groups, work);
        warp.elements += record.lanes();
        resume_slot_ = warp.slot + 1;
        if (warp.left || advance_to_access(warp, work)) {
            ++turn_;
            return none;
        }
        const unsigned cta_slot = warp.slot / warps_per_cta_;
        ended_.push_back(std::move(traces_[warp.slot]));
        active_.erase(active_.begin() + static_cast<std::ptrdiff_t>(turn_));
        return --unfinished_[cta_slot] > 0 ? none : cta_slot;
    }

    /// Counts ray starts up to the next access; false if there is none.
    static bool advance_to_access(Warp& warp, Workspace& work) {
        for (; warp.next != warp.end; ++warp.next) {
            if (warp.next->is_access()) {
                warp.left = warp.next->mask;
                return true;
            }
            work.tally.add_rays(*warp.next, *warp.groups);
        }
        return false;
    }

    SmCaches& memory_;
    unsigned warps_per_cta_, l1_per_sm_, simd_width_;
    std::vector<Warp> active_;          ///< unfinished warps by slot
    std::vector<WarpPointer> traces_;   ///< by slot: keeps the records of an unfinished warp
    std::vector<WarpPointer> ended_;    ///< warps whose elements are still to be read
    std::size_t turn_ = 0;              ///< place in active_ of the next to issue; its size means 0
    unsigned resume_slot_ = 0;          ///< the next to issue has this slot or a later one, or the turn wraps
    std::vector<unsigned> unfinished_;  ///< unfinished warps of each CTA slot
};

}  // namespace raycache::cachesim
