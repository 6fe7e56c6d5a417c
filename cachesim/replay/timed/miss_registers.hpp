// Miss-status holding registers of one cache: a sector on its way takes one, until it is there. Whoever asks for it
// meanwhile waits at the register until the arrival is known.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "cachesim/replay/timed/cycle.hpp"
#include "cachesim/replay/timed/pool.hpp"

namespace raycache::cachesim {

class MissRegisters {
public:
    static constexpr std::uint32_t none = ~std::uint32_t{0};

    struct Register {
        Cycle since = 0;
        Cycle arrival = never;         ///< of the sector; `never` if it is not known yet
        std::uint32_t entry = 0;       ///< of the cache, or of the lines on their way where it allocates on fill
        std::uint32_t waiters = none;  ///< the last that came to wait
        std::uint32_t merged = 1;      ///< look-ups of the sector since it set off
        std::uint32_t sector = 0;      ///< of the line
        std::uint32_t next = none;     ///< another one of the same entry
    };

    /// At most `count` sectors of `entries` lines at once.
    MissRegisters(std::uint32_t count, std::size_t entries) : count_(count), of_entry_(entries, none) {}

    bool full() const { return taken_ == count_; }
    bool empty() const { return taken_ == 0; }

    Register& operator[](std::uint32_t number) { return registers_[number]; }
    const Register& operator[](std::uint32_t number) const { return registers_[number]; }

    /// The register is about to be used; then what it leads to.
    void prefetch(std::uint32_t number) const { __builtin_prefetch(&registers_[number], 1); }
    void prefetch_others(std::uint32_t number) const {
        const Register& r = registers_[number];
        if (r.waiters != none) __builtin_prefetch(&waiters_[r.waiters], 1);
        __builtin_prefetch(&of_entry_[r.entry], 1);
    }

    /// The register of a sector that is on its way.
    std::uint32_t find(std::uint32_t entry, std::uint32_t sector) const {
        std::uint32_t number = of_entry_[entry];
        while (registers_[number].sector != sector) number = registers_[number].next;
        return number;
    }

    /// Must not be full. Returns its number.
    std::uint32_t take(std::uint32_t entry, std::uint32_t sector, Cycle since) {
        const std::uint32_t number = registers_.take({since, never, entry, none, 1, sector, of_entry_[entry]});
        of_entry_[entry] = number;
        ++taken_;
        return number;
    }

    /// The sector is there, and nobody waits.
    void give_back(std::uint32_t number) {
        std::uint32_t* link = &of_entry_[registers_[number].entry];
        while (*link != number) link = &registers_[*link].next;
        *link = registers_[number].next;
        registers_.give_back(number);
        --taken_;
    }

    /// `who` is to be told when the arrival of the register's sector is known. What these numbers mean, the owner of
    /// the cache says.
    void wait(std::uint32_t number, std::uint32_t who, std::uint8_t l1 = 0) {
        Register& r = registers_[number];
        r.waiters = waiters_.take({who, r.waiters, l1});
    }

    /// Calls tell(who, l1) for all that wait, those that came last first. None waits any longer.
    template <class Tell>
    void tell_waiters(std::uint32_t number, const Tell& tell) {
        std::uint32_t at = std::exchange(registers_[number].waiters, none);
        while (at != none) {
            const Waiter waiter = waiters_[at];
            waiters_.give_back(at);
            at = waiter.next;
            tell(waiter.who, waiter.l1);
        }
    }

private:
    struct Waiter {
        std::uint32_t who, next;
        std::uint8_t l1;
    };

    std::uint32_t count_, taken_ = 0;
    Pool<Register> registers_;
    std::vector<std::uint32_t> of_entry_;  ///< of each entry, the first
    Pool<Waiter> waiters_;
};

}  // namespace raycache::cachesim
