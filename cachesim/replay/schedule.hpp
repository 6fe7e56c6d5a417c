// Which SM issues when: all SMs in turn, one warp access each and round after round, without simulating them in turn.
//
// A cache never decides who issues next, so an SM may run many rounds of a window before the next SM does, and finds
// its warps and L1s in the caches of the machine that simulates it. Two things tie SMs together. The shared level sees
// them in turn: Hierarchy collects what they ask of it until the window ends. And CTAs go to slots in the order in
// which these become free: an SM that frees a slot waits for its next CTA, and no SM after it in turn runs beyond that
// round meanwhile. So SMs before it are as far as it is or further, SMs after it are not, and the accesses of each
// round come in turn. All that is decided here needs no cache, so the caches may answer later, on other threads.
#pragma once

#include <algorithm>
#include <compare>
#include <cstddef>
#include <functional>
#include <optional>
#include <queue>
#include <span>
#include <vector>

#include "cachesim/replay/hierarchy.hpp"
#include "cachesim/replay/multiprocessor.hpp"

namespace raycache::cachesim {

/// A slot for one CTA, free since this round of the window.
struct FreeSlot {
    std::size_t round = 0, sm = 0;
    unsigned slot = 0;
    auto operator<=>(const FreeSlot&) const = default;
};

class Schedule {
public:
    Schedule(const Gpu& gpu, unsigned cta_slots, Hierarchy& memory)
        : memory_(memory), reached_(gpu.sms), waits_(gpu.sms) {
        for (unsigned sm = 0; sm < gpu.sms; ++sm) sms_.emplace_back(cta_slots, gpu, memory.sm(sm));
    }

    /// Makes a CTA resident before its SM runs on, at first before any does.
    void place(std::size_t sm, unsigned slot, std::span<const PushedWarp> cta) {
        sms_[sm].place(slot, cta, memory_.workspace());
    }

    /// The slot that becomes free first. Its SM waits until resume(). Nothing if no warp is left.
    std::optional<FreeSlot> next_free() {
        while (waiting_.empty()) {
            memory_.end_window();
            for (Multiprocessor& sm : sms_) sm.forget_ended();
            if (std::all_of(sms_.begin(), sms_.end(), [](const Multiprocessor& sm) { return sm.idle(); }))
                return std::nullopt;
            std::fill(reached_.begin(), reached_.end(), std::size_t{0});
            memory_.begin_window();
            run(0, 0);
        }
        return waiting_.top();
    }

    /// Lets the SM of next_free() go on.
    void resume() {
        const FreeSlot first = waiting_.top();
        waiting_.pop();
        waits_[first.sm] = false;
        run(first.sm, first.round + 1);
    }

private:
    /// Lets SMs run as far as they may, from one that waits no longer; it and all after it had at most reached
    /// `before`.
    void run(std::size_t first, std::size_t before) {
        std::size_t limit = first == 0 ? memory_.rounds() : reached_[first - 1];
        for (std::size_t sm = first; sm < sms_.size() && limit > before; ++sm) {
            if (sm + 1 < sms_.size()) sms_[sm + 1].prefetch();
            if (!waits_[sm]) {
                if (const auto slot = sms_[sm].run(reached_[sm], limit, memory_.workspace())) {
                    waiting_.push({reached_[sm] - 1, sm, *slot});
                    waits_[sm] = true;
                }
                if (memory_.end_run(sm)) sms_[sm].forget_ended();
            }
            limit = reached_[sm];
        }
    }

    Hierarchy& memory_;
    std::vector<Multiprocessor> sms_;
    std::vector<std::size_t> reached_;  ///< by SM: rounds of the window that it has run
    std::vector<bool> waits_;           ///< by SM: whether it stands in waiting_
    std::priority_queue<FreeSlot, std::vector<FreeSlot>, std::greater<>> waiting_;  ///< earliest first
};

}  // namespace raycache::cachesim
