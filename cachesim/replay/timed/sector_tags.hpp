// The tags of one sectored set-associative cache that knows when each of its sectors arrives.
//
// A sector is absent, or present with the cycle at which its data are there: in the past (a hit), in the future (on its
// way), or not known yet. A line with a sector on its way is never evicted. Evicts the least recently used of the other
// lines, or the one that came first (fifo).
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <vector>

#include "cachesim/cache/divider.hpp"

namespace raycache::cachesim {

using Cycle = std::uint64_t;

class SectorTags {
public:
    static constexpr std::uint32_t none = ~std::uint32_t{0};
    static constexpr Cycle unknown = ~Cycle{0};

    /// All sets empty. sets * ways < 2^32 - 1, ways < 2^16; at most 32 sectors per line.
    SectorTags(std::uint64_t sets, std::uint64_t ways, std::uint32_t sectors_per_line, bool fifo)
        : ways_(ways),
          by_ways_(ways),
          sectors_(sectors_per_line),
          fifo_(fifo),
          shift_(64 - static_cast<int>(std::bit_width(std::bit_ceil(2 * sets * ways) - 1))),
          lines_(sets * ways),
          newest_(sets),
          arrival_(sets * ways * sectors_per_line),
          chains_(std::bit_ceil(2 * sets * ways), none) {
        for (std::uint64_t set = 0; set < sets; ++set) {
            for (std::uint64_t way = 0; way < ways; ++way) {
                lines_[set * ways + way].older = static_cast<std::uint16_t>((way + 1) % ways);
                lines_[set * ways + way].newer = static_cast<std::uint16_t>((way + ways - 1) % ways);
            }
        }
    }

    /// The entry that holds the line, or none.
    std::uint32_t find(std::uint64_t line) const {
        std::uint32_t at = chains_[bucket(line)];
        while (at != none && lines_[at].line != line) at = lines_[at].next;
        return at;
    }
    bool holds(std::uint32_t entry, std::uint64_t line) const {
        return lines_[entry].present != 0 && lines_[entry].line == line;
    }

    std::uint64_t line(std::uint32_t entry) const { return lines_[entry].line; }
    bool present(std::uint32_t entry, std::uint32_t sector) const { return lines_[entry].present >> sector & 1; }
    /// Whether a present sector's data are there. Most often the line alone can tell.
    bool arrived(std::uint32_t entry, std::uint32_t sector, Cycle now) const {
        return lines_[entry].last_arrival <= now || arrival(entry, sector) <= now;
    }
    Cycle arrival(std::uint32_t entry, std::uint32_t sector) const { return arrival_[entry * sectors_ + sector]; }

    /// The line was looked up.
    void use(std::uint32_t entry) {
        if (fifo_) return;
        const auto [set, way] = by_ways_(entry);
        make_newest(set, static_cast<std::uint16_t>(way));
    }

    /// Takes in an absent sector, whose data arrive then.
    void add(std::uint32_t entry, std::uint32_t sector, Cycle arrival) {
        lines_[entry].present |= 1u << sector;
        set_arrival(entry, sector, arrival);
    }
    void set_arrival(std::uint32_t entry, std::uint32_t sector, Cycle arrival) {
        arrival_[entry * sectors_ + sector] = arrival;
        Line& line = lines_[entry];
        if (arrival >= line.last_arrival) {
            line.last_arrival = arrival;
            return;
        }
        find_last_arrival(entry);
    }

    /// Takes out a sector that is present. An entry without sectors holds no line.
    void remove(std::uint32_t entry, std::uint32_t sector) {
        Line& line = lines_[entry];
        line.present &= ~(1u << sector);
        find_last_arrival(entry);
        if (line.present == 0) unchain(entry);
    }

    /// Evicts a line of the set for this one, which is absent; its sectors are absent as yet. `none` if every line of
    /// the set has a sector on its way.
    std::uint32_t replace(std::uint64_t set, std::uint64_t line, Cycle now) {
        const auto first = static_cast<std::uint32_t>(set * ways_);
        Line* const lines = &lines_[first];
        const std::uint16_t oldest = lines[newest_[set]].newer;
        std::uint16_t way = oldest;
        while (lines[way].last_arrival > now) {
            way = lines[way].newer;
            if (way == oldest) return none;
        }
        const std::uint32_t victim = first + way;
        Line& entry = lines_[victim];
        if (entry.present) unchain(victim);
        make_newest(set, way);
        entry.line = line;
        entry.present = 0;
        entry.last_arrival = 0;
        std::uint32_t& chain = chains_[bucket(line)];
        entry.next = chain;
        chain = victim;
        return victim;
    }

private:
    struct Line {
        std::uint64_t line = 0;
        Cycle last_arrival = 0;              ///< of the sectors that are present
        std::uint32_t present = 0;           ///< bit s: sector s
        std::uint32_t next = none;           ///< the chain of the bucket
        std::uint16_t older = 0, newer = 0;  ///< ways, a ring of the set; the newest's `newer` is the oldest
    };
    static_assert(sizeof(std::uint64_t) + sizeof(Cycle) + 12 <= 32);  // two lines to a cache line of the machine

    /// Multiplicative hashing (Knuth, The Art of Computer Programming 3, section 6.4).
    std::uint64_t bucket(std::uint64_t line) const { return (line * 0x9e3779b97f4a7c15ull) >> shift_; }

    void unchain(std::uint32_t entry) {
        std::uint32_t* link = &chains_[bucket(lines_[entry].line)];
        while (*link != entry) link = &lines_[*link].next;
        *link = lines_[entry].next;
    }

    void find_last_arrival(std::uint32_t entry) {
        Line& line = lines_[entry];
        line.last_arrival = 0;
        for (std::uint32_t present = line.present; present; present &= present - 1)
            line.last_arrival =
                std::max(line.last_arrival, arrival(entry, static_cast<std::uint32_t>(std::countr_zero(present))));
    }

    void make_newest(std::uint64_t set, std::uint16_t way) {
        std::uint16_t& newest = newest_[set];
        if (way == newest) return;
        Line* const lines = &lines_[set * ways_];
        Line& line = lines[way];
        lines[line.newer].older = line.older;
        lines[line.older].newer = line.newer;
        const std::uint16_t second = newest, oldest = lines[second].newer;
        line.older = second;
        line.newer = oldest;
        lines[second].newer = way;
        lines[oldest].older = way;
        newest = way;
    }

    std::uint64_t ways_;
    Divider by_ways_;
    std::uint32_t sectors_;
    bool fifo_;
    int shift_;
    std::vector<Line> lines_;
    std::vector<std::uint16_t> newest_;  ///< way, of each set
    std::vector<Cycle> arrival_;         ///< of each sector of each entry
    std::vector<std::uint32_t> chains_;
};

}  // namespace raycache::cachesim
