// One cache in time: its lines, the sectors on their way to it, and when they arrive.
//
// A cache that allocates on miss gives up a line as soon as it asks for the new one. One that allocates on fill keeps
// what it has until the data are there: lines on their way stand apart, as many as there are registers.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include "cachesim/gpus/gpu.hpp"
#include "cachesim/replay/timed/cycle.hpp"
#include "cachesim/replay/timed/miss_registers.hpp"
#include "cachesim/replay/timed/ring.hpp"
#include "cachesim/replay/timed/sector_cache.hpp"

namespace raycache::cachesim {

class TimedCache {
public:
    static constexpr std::uint32_t none = SectorCache::none;

    /// Empty. `number`: of the cache in its level. At most `registers` sectors on their way at once.
    TimedCache(const CacheGeometry&, unsigned number, std::uint32_t registers);

    SectorCache& lines() { return lines_; }
    const SectorCache& lines() const { return lines_; }
    MissRegisters& registers() { return registers_; }
    const MissRegisters& registers() const { return registers_; }

    /// Takes in what arrives by `now`.
    void drain(Cycle now) {
        while (next_arrival_ <= now) [[unlikely]] take_in();
    }
    /// Of the next sector whose arrival is known, or `never`.
    Cycle next_arrival() const { return next_arrival_; }

    /// The sector of a register is about to arrive.
    void prefetch_line(std::uint32_t register_number) const {
        registers_.prefetch_others(register_number);
        (coming_ ? *coming_ : lines_).prefetch_entry(registers_[register_number].entry);
    }

    /// The register of a sector of this line that is on its way, or none. `entry`: where lines() holds the line, or
    /// none.
    std::uint32_t find_pending(std::uint32_t line, std::uint32_t sector, std::uint32_t entry) const;

    /// An absent sector that is not on its way sets off, `now`. `set`: where the line goes. Returns its register, and
    /// in `entry` where the line is or will be, if that is known; or none if all lines that could make room have a
    /// sector on its way. There must be a free register.
    std::uint32_t send_for(std::uint32_t line, std::uint32_t sector, std::uint64_t set, std::uint32_t& entry,
                           Cycle now);

    /// Sends for what a fill brings beside a sector that has just set off, as far as there are registers: the absent
    /// sectors of the same group of `fill_sectors`. Calls sent(register, sector) for each.
    template <class Sent>
    void send_for_neighbours(std::uint32_t fill_sectors, std::uint32_t line, std::uint32_t sector, std::uint64_t set,
                             std::uint32_t& entry, Cycle now, const Sent& sent) {
        const std::uint32_t first = sector / fill_sectors * fill_sectors;
        for (std::uint32_t s = first; s < first + fill_sectors && !registers_.full(); ++s) {
            if (entry != none && (lines_[entry].present >> s & 1)) continue;
            if (find_pending(line, s, entry) != none) continue;
            if (const std::uint32_t number = send_for(line, s, set, entry, now); number != none) sent(number, s);
        }
    }

    /// What was unknown is known now; not before the last drain(). Returns how long the register is taken.
    Cycle set_arrival(std::uint32_t number, Cycle arrival) {
        registers_[number].arrival = arrival;
        arrivals_.insert({arrival, number}, [](const Arrival& a, const Arrival& b) { return a.time < b.time; });
        next_arrival_ = arrivals_.front().time;
        return arrival - std::min(arrival, registers_[number].since);
    }

private:
    struct Arrival {
        Cycle time = 0;
        std::uint32_t number = 0;
    };

    void take_in();

    SectorCache lines_;
    /// Allocate::on_fill: lines on their way, of which registers hold entries; and the sets they will go to.
    std::optional<SectorCache> coming_;
    std::vector<std::uint64_t> set_of_;
    MissRegisters registers_;
    Ring<Arrival> arrivals_;  ///< in order of time
    Cycle next_arrival_ = never;
};

}  // namespace raycache::cachesim
