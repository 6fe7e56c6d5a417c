// How fast an SM answers look-ups whose sector came from below: Timing::answers_per_cycle.
#pragma once

#include <algorithm>
#include <cstdint>

#include "cachesim/replay/timed/cycle.hpp"

namespace raycache::cachesim {

class AnswerRate {
public:
    /// 0: any number in a cycle.
    explicit AnswerRate(std::uint32_t per_cycle) : per_cycle_(per_cycle) {}

    /// A sector arrives: whoever waited for it is answered from then on, and not before those that waited for sectors
    /// whose arrival was known earlier.
    void begin(Cycle arrival) {
        if (arrival <= cycle_) return;
        cycle_ = arrival;
        answered_ = 0;
    }

    /// When the next is answered.
    Cycle answer() {
        const Cycle cycle = cycle_;
        if (per_cycle_ != 0 && ++answered_ == per_cycle_) {
            ++cycle_;
            answered_ = 0;
        }
        return cycle;
    }

private:
    std::uint32_t per_cycle_, answered_ = 0;  ///< answered_: in this cycle
    Cycle cycle_ = 0;
};

}  // namespace raycache::cachesim
