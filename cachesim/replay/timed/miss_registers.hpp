// Miss-status holding registers of one cache: a sector on its way takes one, until it is there.
#pragma once

#include <cstddef>
#include <cstdint>
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
        std::uint32_t waiters = none;  ///< who waits for the arrival to be known: the cache's owner says what this is
        std::uint32_t merged = 1;      ///< look-ups of the sector since it set off
        std::uint32_t sector = 0;      ///< of the line
        std::uint32_t next = none;     ///< another one of the same entry
    };

    /// At most `count` sectors of `entries` lines at once.
    MissRegisters(std::uint32_t count, std::size_t entries) : count_(count), of_entry_(entries, none) {}

    bool full() const { return taken_ == count_; }
    bool empty() const { return taken_ == 0; }

    Register& operator[](std::uint32_t number) { return registers_[number]; }

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

    /// The sector is there.
    void give_back(std::uint32_t number) {
        std::uint32_t* link = &of_entry_[registers_[number].entry];
        while (*link != number) link = &registers_[*link].next;
        *link = registers_[number].next;
        registers_.give_back(number);
        --taken_;
    }

private:
    std::uint32_t count_, taken_ = 0;
    Pool<Register> registers_;
    std::vector<std::uint32_t> of_entry_;  ///< of each entry, the first
};

}  // namespace raycache::cachesim
