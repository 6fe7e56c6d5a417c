// One scheduler of an SM: which of its flights issues next, and when its issue slot is free.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "cachesim/gpus/gpu.hpp"
#include "cachesim/replay/timed/cycle.hpp"

namespace raycache::cachesim {

class WarpScheduler {
public:
    /// At most 64 flights, each a bit.
    explicit WarpScheduler(const Gpu&);

    void assign(unsigned bit, std::uint32_t flight) { flight_of_[bit] = static_cast<std::uint16_t>(flight); }
    std::uint32_t flight(unsigned bit) const { return flight_of_[bit]; }

    /// The flight's warp becomes resident; `age`: order of that.
    void become_resident(unsigned bit, std::uint64_t age) { age_[bit] = age; }
    /// The next kernel begins: none is ready, and none has issued anything.
    void end_kernel() {
        last_ = 63;
        free_ = 0;
    }

    /// Of those that are able (bits, not none), the one whose turn it is. It counts as the last to issue.
    unsigned pick(std::uint64_t able);

    // Loads, where they wait for the port (without Timing::operand_collectors).

    void make_ready(unsigned bit) { ready_ |= std::uint64_t{1} << bit; }
    /// Whether a flight is ready and there is room for its load.
    bool can_issue() const { return ready_ != 0 && queued_ < load_queue_; }
    /// The flight whose turn it is, as its bit.
    unsigned pick_ready() { return pick(ready_); }
    /// A load of it issues; `last`: of its visit.
    void issue_load(unsigned bit, bool last, Cycle time) {
        if (last) ready_ &= ~(std::uint64_t{1} << bit);
        ++queued_;
        free_ = std::max(free_, time) + 1;
    }
    /// A load has passed the port.
    void load_passed() { --queued_; }

    /// Instructions of a visit that begin at that time, but for the `early` ones that have issued meanwhile: as a
    /// block, after those that began before. Returns when the last of them has issued.
    Cycle run(Cycle time, std::uint32_t count, std::uint32_t early);

private:
    std::uint32_t load_queue_, interval_, chains_, round_;  ///< round_: cycles of one instruction of each chain
    bool round_robin_;
    std::uint64_t ready_ = 0;
    unsigned last_ = 63;
    std::uint32_t queued_ = 0;                   ///< its loads that have not passed the port
    Cycle free_ = 0;                             ///< when it has issued all instructions so far
    std::array<std::uint16_t, 64> flight_of_{};  ///< by bit
    std::array<std::uint64_t, 64> age_{};        ///< by bit: of the flight's warp
};

}  // namespace raycache::cachesim
