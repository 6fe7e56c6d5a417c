// Which loads an instruction of a warp waits for, told by registers, as a GPU's scoreboard does: an instruction issues
// when no load is under way that writes a register which it reads or writes, and those behind it issue after it.
//
// Only loads write registers late: what computes an address, a predicate or a uniform register from loaded data has
// waited for the data itself, so what reads that waits for nothing more. LDGSTS writes no register; LDGDEPBAR ends a
// group of them, and DEPBAR n waits for all groups but the last n (as in Accel-Sim; copies that end at another kind of
// barrier are waited for by nothing).
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <deque>
#include <utility>
#include <vector>

#include "traces/accelsim/register_set.hpp"

namespace raycache::traces {

/// A wait, and instructions behind it: `needs` as IssueStep has it, by the numbers that Scoreboard::load() was given.
struct LoadStep {
    std::uint32_t needs = 0, instructions = 0;
    bool operator==(const LoadStep&) const = default;
};

class Scoreboard {
public:
    /// Nothing is under way, and no step waits to be taken.
    void begin_warp() {
        pending_.reset();
        groups_.assign(1, {});
        steps_.clear();
    }

    /// An instruction that is none of the loads and stores handed on.
    void instruction(const RegisterSet& used) {
        wait(used);
        if (steps_.empty()) steps_.emplace_back();
        ++steps_.back().instructions;
    }

    /// Before what reads or writes these registers.
    void wait(const RegisterSet& used) {
        RegisterSet late = pending_ & used;
        for (std::size_t r = 0; late.any(); ++r)
            if (late[r]) {
                wait_for(load_of_[r]);
                late &= pending_;
            }
    }

    /// Load number `number` of the warp issues.
    void load(const RegisterSet& written, std::uint32_t number) {
        pending_ |= written;
        for (std::size_t r = 0, left = written.count(); left > 0; ++r)
            if (written[r]) {
                load_of_[r] = number;
                --left;
            }
    }

    void async_copy(std::uint32_t number) {
        std::vector<std::uint32_t>& group = groups_.back();
        if (group.size() == most) group.erase(group.begin());
        if (group.empty() || group.back() != number) group.push_back(number);
    }
    void end_group() {
        if (groups_.size() == most) groups_.pop_front();
        groups_.emplace_back();
    }
    /// All groups that have ended but for the last `left` of them.
    void wait_for_groups(std::uint64_t left) {
        while (groups_.size() - 1 > left) {
            for (const std::uint32_t number : groups_.front()) wait_for(number);
            groups_.pop_front();
        }
    }

    /// What there was since the last call.
    std::vector<LoadStep> take() { return std::exchange(steps_, {}); }

private:
    /// Copies of a group and groups that are remembered: a timed replay has no more of a warp under way.
    static constexpr std::size_t most = 64;

    void wait_for(std::uint32_t number) {
        steps_.push_back({number + 1, 0});
        for (std::size_t r = 0; r < load_of_.size(); ++r)
            if (pending_[r] && load_of_[r] == number) pending_.reset(r);
    }

    RegisterSet pending_;                                ///< a load under way writes it
    std::array<std::uint32_t, 256> load_of_{};           ///< by register of pending_
    std::deque<std::vector<std::uint32_t>> groups_{{}};  ///< of asynchronous copies; the last one goes on
    std::vector<LoadStep> steps_;
};

}  // namespace raycache::traces
