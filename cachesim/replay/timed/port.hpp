// One L1 of an SM with its port: loads wait in order, each takes as many cycles as Timing::l1_port says and looks up
// its sectors meanwhile. The rule is Port::follow(); what a later load of a visit asks for may go past it
// (Port::repeat()), with the same results.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "cachesim/replay/timed/answer_rate.hpp"
#include "cachesim/replay/timed/load_walk.hpp"
#include "cachesim/replay/timed/memory_side.hpp"
#include "cachesim/replay/timed/port_clock.hpp"
#include "cachesim/replay/timed/ring.hpp"
#include "cachesim/replay/timed/timed_cache.hpp"
#include "cachesim/replay/timed/timed_rules.hpp"
#include "cachesim/replay/timed/timed_statistics.hpp"
#include "cachesim/replay/timed/visit.hpp"

namespace raycache::cachesim {

/// A visit under way, as ports see it.
struct VisitAtPort {
    const LoadShape* shape = nullptr;
    std::uint32_t region = 0;
    std::uint32_t passed = 0;  ///< loads
    /// What the first load found, and when (LoadShape::steady): bit i: all sectors of element i were there, and its
    /// line was used after `found_since`; how many lines these are; in which cycle of the load each was asked.
    std::uint32_t there = 0, found_since = 0, lines = 0;
    std::array<std::uint8_t, traces::warp_lanes> cycle{};
    Visit visit;
    /// By element of the visit and line of the element, modulo 2: where the L1 held it when it was last looked up.
    std::array<std::uint32_t, 2 * traces::warp_lanes> entries{};
};

/// Data that a flight waits for: of all loads of its visit, or of one.
struct LoadData {
    Cycle arrival = 0;             ///< of the latest sector so far
    std::uint32_t unresolved = 0;  ///< sectors whose arrival is not known
    std::uint32_t flight = 0;
    bool asked = false;  ///< the L1 has looked up all sectors

    bool known() const { return asked && unresolved == 0; }
};

class Port {
public:
    /// A load on its way through the port.
    struct Load {
        VisitAtPort* visit = nullptr;
        std::uint32_t flight = 0;
        std::uint32_t number = 0;  ///< of the visit
        std::uint32_t data = 0;    ///< of the SM
    };
    struct Counts {
        LevelAnswers answers;
        double busy = 0, tags = 0, registers = 0;  ///< cycles of the port; lines; cycles of registers for misses
    };

    /// L1 number `number` of the SM, empty. Misses go to `lacks`, in order of time. All references and what the
    /// pointers lead to must outlive this object.
    Port(const TimedRules&, LineIds&, std::uint16_t sm, std::uint8_t number, LoadData* data,
         std::vector<MissRequest>& lacks);

    bool empty() const { return queue_.empty(); }
    /// When the load at the front can begin or go on.
    Cycle free() const { return free_; }

    void push(const Load& load) { queue_.push(load); }
    /// The data lie there from now on.
    void use(LoadData* data) { data_ = data; }
    /// The port takes nothing before this cycle.
    void hold(Cycle until) { free_ = until; }

    /// Serves the load at the front from `now` on, as far as `end`: now >= free(). Returns it if it has passed.
    std::optional<Load> serve(Cycle now, Cycle end);

    /// The arrival of a register's sector is about to be known: what that takes comes nearer, in two steps.
    void prefetch(std::uint32_t register_number) const { cache_.registers().prefetch(register_number); }
    void prefetch_line(std::uint32_t register_number) const { cache_.prefetch_line(register_number); }

    /// When the sector of a register arrives is known. Calls known(data) for data that are complete by that.
    template <class Known>
    void arrive(std::uint32_t register_number, Cycle time, AnswerRate& rate, const Known& known) {
        counts_.registers += static_cast<double>(cache_.set_arrival(register_number, time));
        rate.begin(time);
        cache_.registers().tell_waiters(register_number, [&](std::uint32_t who, std::uint8_t) {
            LoadData& data = data_[who];
            data.arrival = std::max(data.arrival, rate.answer());
            --data.unresolved;
            if (data.known()) known(who);
        });
    }

    /// The next kernel begins: nothing waits, no miss is on its way. `keep`: the L1 keeps its lines, else it is empty.
    void end_kernel(bool keep);

    const Counts& counts() const { return counts_; }

private:
    static constexpr std::uint32_t none = TimedCache::none;

    template <class Clock>
    std::optional<Load> serve_by(Clock&, Cycle now, Cycle end);
    template <class Walk, class Clock>
    bool follow(Clock&, Cycle now, Cycle end);
    bool can_repeat(Cycle now, Cycle end);
    bool repeat(Cycle now, Cycle end);
    bool look_up(const Load&, std::uint32_t id, std::uint32_t sector, std::uint32_t& known, Cycle);
    bool miss(const Load&, std::uint32_t sector, std::uint32_t id, std::uint32_t& entry, Cycle);
    void end_load(Cycle begin, Cycle end);
    void try_again(Cycle now, Cycle end) { free_ = std::min(end, std::max(now + 1, cache_.next_arrival())); }

    const TimedRules& rules_;
    LineIds& ids_;
    std::uint16_t sm_;
    std::uint8_t number_;
    LoadData* data_;
    std::vector<MissRequest>& lacks_;
    TimedCache cache_;
    Ring<Load> queue_{};  ///< in order of issue
    Cycle free_ = 0;
    LoadPlace place_;  ///< of the load at the front
    TagClock tags_;
    BankClock banks_;
    Counts counts_;
};

}  // namespace raycache::cachesim
