// Instructions on their way from the schedulers of an SM to its units, one by one, as GPGPU-Sim 4 has it with generic
// operand collectors (its shader.cc: opndcoll_rfu_t). Loads and arithmetic share the collectors of a scheduler, so
// where arithmetic is slow, loads wait with it.
//
// An issued instruction is in a register of its scheduler and kind, then in a collector of the scheduler, then again in
// a register, until its unit takes it; each step takes at least a cycle. Of each kind the oldest instruction of all
// schedulers goes to a collector first: while its scheduler has none free, those of other schedulers wait with it.
// Register banks are left out.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "cachesim/gpus/timing.hpp"
#include "cachesim/replay/timed/cycle.hpp"

namespace raycache::cachesim {

/// From issue to the port: register, collector, register, and the load unit's own register. Part of l1_latency.
inline constexpr Cycle issue_to_port = 4;

class OperandCollectors {
public:
    enum Kind : std::uint8_t { arithmetic, load };
    static constexpr unsigned kinds = 2, most = 32;

    struct Instruction {
        std::uint64_t age = 0;  ///< order of issue
        std::uint32_t flight = 0;
        std::uint32_t number = 0;  ///< of its kind, of the visit
        Kind kind = arithmetic;
        std::uint32_t place = 0;  ///< of a load's visit, in PendingAccesses
    };

    /// At most 64 schedulers and `most` collectors of each.
    OperandCollectors(unsigned schedulers, unsigned collectors)
        : all_(static_cast<std::uint32_t>((std::uint64_t{1} << collectors) - 1)), of_(schedulers) {}

    bool empty() const { return inside_ == 0; }

    bool takes(unsigned scheduler, Kind kind) const { return !(issued_[kind] >> scheduler & 1); }
    void issue(unsigned scheduler, std::uint32_t flight, std::uint32_t number, Kind kind, std::uint32_t place = 0) {
        of_[scheduler].issued[kind] = {age_++, flight, number, kind, place};
        issued_[kind] |= std::uint64_t{1} << scheduler;
        ++inside_;
    }

    /// Bit: scheduler whose instruction waits for its unit.
    std::uint64_t collected(Kind kind) const { return collected_[kind]; }
    const Instruction& collected(unsigned scheduler, Kind kind) const { return of_[scheduler].collected[kind]; }
    Instruction take(unsigned scheduler, Kind kind) {
        collected_[kind] &= ~(std::uint64_t{1} << scheduler);
        --inside_;
        return of_[scheduler].collected[kind];
    }

    /// One cycle, after the units took what they take, and before the schedulers issue. Returns whether anything moved.
    bool advance() {
        bool moved = false;
        for (unsigned s = 0; s < of_.size(); ++s) moved |= leave_collectors(s);
        for (bool more = true; more; moved |= more) {
            more = false;
            for (const Kind kind : {arithmetic, load}) more |= enter_collector(kind);
        }
        return moved;
    }

private:
    struct OfScheduler {
        std::array<Instruction, kinds> issued{}, collected{};
        std::array<Instruction, most> collectors{};
        std::uint32_t used = 0;  ///< bit: collector
    };

    /// Collectors of lower numbers go first.
    bool leave_collectors(unsigned scheduler) {
        OfScheduler& s = of_[scheduler];
        const std::uint64_t bit = std::uint64_t{1} << scheduler;
        bool moved = false;
        for (std::uint32_t left = s.used; left; left &= left - 1) {
            const Instruction& at = s.collectors[static_cast<unsigned>(std::countr_zero(left))];
            if (collected_[at.kind] & bit) continue;
            s.collected[at.kind] = at;
            collected_[at.kind] |= bit;
            s.used &= ~(left & -left);
            moved = true;
        }
        return moved;
    }

    bool enter_collector(Kind kind) {
        if (!issued_[kind]) return false;
        auto oldest = static_cast<unsigned>(std::countr_zero(issued_[kind]));
        for (std::uint64_t left = issued_[kind] & (issued_[kind] - 1); left; left &= left - 1) {
            const auto s = static_cast<unsigned>(std::countr_zero(left));
            if (of_[s].issued[kind].age < of_[oldest].issued[kind].age) oldest = s;
        }
        OfScheduler& s = of_[oldest];
        if (s.used == all_) return false;
        const int free = std::countr_one(s.used);
        s.collectors[static_cast<unsigned>(free)] = s.issued[kind];
        s.used |= std::uint32_t{1} << free;
        issued_[kind] &= ~(std::uint64_t{1} << oldest);
        return true;
    }

    std::uint32_t all_;  ///< a scheduler's collectors
    std::vector<OfScheduler> of_;
    std::array<std::uint64_t, kinds> issued_{}, collected_{};  ///< bit: scheduler whose register is taken
    std::uint64_t age_ = 0, inside_ = 0;
};

/// What an SM keeps of its instructions one by one.
struct InstructionFlow {
    InstructionFlow(const Timing& timing, std::size_t flights)
        : collectors(timing.schedulers, timing.operand_collectors),
          visits(flights),
          results(flights * timing.dependent_chains),
          ready(timing.schedulers),
          unit_free(timing.schedulers) {}

    bool idle() const {
        return collectors.empty() &&
               std::all_of(ready.begin(), ready.end(), [](const auto& bits) { return (bits[0] | bits[1]) == 0; });
    }

    /// A visit of a flight, its loads first.
    struct Visit {
        std::uint32_t loads = 0, instructions = 0;
        std::uint32_t next = 0;     ///< to issue
        std::uint32_t unknown = 0;  ///< loads whose data come it is not known when
        bool waits = false;         ///< the next one, for something whose time is not known
        Cycle latest = 0;           ///< of the data so far

        bool over() const { return next == loads + instructions; }
    };

    OperandCollectors collectors;
    std::vector<Visit> visits;                        ///< by flight
    std::vector<Cycle> results;                       ///< by flight * dependent_chains + number mod dependent_chains
    std::vector<std::array<std::uint64_t, 2>> ready;  ///< by scheduler and kind: bits of flights whose next may issue
    std::vector<Cycle> unit_free;                     ///< by scheduler: its arithmetic unit
};

}  // namespace raycache::cachesim
