// Least recently used, for many ways and any line numbers: a hash table finds the line, a ring of the set's ways keeps
// the order of last use. Every look-up takes constant time, whatever the associativity.
#pragma once

#include <bit>
#include <cstdint>
#include <vector>

#include "cachesim/cache/request.hpp"

namespace raycache::cachesim {

class LruManyWays {
public:
    /// sets * ways must be below 2^32.
    LruManyWays(std::uint64_t sets, std::uint64_t ways, unsigned /*sectors_per_line*/)
        : shift_(64 - static_cast<int>(std::bit_width(sets * ways))),
          ways_(sets * ways),
          newest_(sets),
          chains_(std::uint64_t{1} << (64 - shift_), none) {
        for (std::uint64_t set = 0; set < sets; ++set) {
            newest_[set] = static_cast<std::uint32_t>(set * ways);
            for (std::uint64_t way = 0; way < ways; ++way) {
                Way& entry = ways_[set * ways + way];
                entry.older = static_cast<std::uint32_t>(set * ways + (way + 1) % ways);
                entry.newer = static_cast<std::uint32_t>(set * ways + (way + ways - 1) % ways);
            }
        }
    }

    void prefetch(std::uint64_t set, const Request& request) const {
        __builtin_prefetch(&chains_[bucket(set, request.line)]);
        __builtin_prefetch(&newest_[set], 1);
    }

    std::uint32_t access(std::uint64_t set, const Request& request) {
        std::uint32_t& chain = chains_[bucket(set, request.line)];
        const auto of_set = static_cast<std::uint32_t>(set);
        for (std::uint32_t at = chain; at != none; at = ways_[at].next) {
            Way& way = ways_[at];
            if (way.line != request.line || way.set != of_set) continue;
            const std::uint32_t missing = request.sectors & ~way.sectors;
            way.sectors |= request.sectors;
            if (at != newest_[set]) make_newest(set, at);
            return missing;
        }
        // The oldest way of the ring stands just before the newest: turning the ring by one evicts it.
        const std::uint32_t victim = ways_[newest_[set]].newer;
        Way& way = ways_[victim];
        if (way.sectors) unchain(victim);
        newest_[set] = victim;
        way.line = request.line;
        way.set = of_set;
        way.sectors = request.sectors;
        way.next = chain;
        chain = victim;
        return request.sectors;
    }

private:
    static constexpr std::uint32_t none = 0xffffffffu;
    struct Way {
        std::uint64_t line = 0;
        std::uint32_t sectors = 0;           ///< 0: empty, in no chain
        std::uint32_t older = 0, newer = 0;  ///< the ring of the set; the newest's `newer` is the oldest
        std::uint32_t next = none;           ///< the chain of the bucket
        std::uint32_t set = 0;
    };

    /// Multiplicative hashing (Knuth, The Art of Computer Programming 3, section 6.4).
    std::uint64_t bucket(std::uint64_t set, std::uint64_t line) const {
        return ((line ^ (set << 40)) * 0x9e3779b97f4a7c15ull) >> shift_;
    }

    void make_newest(std::uint64_t set, std::uint32_t at) {
        Way& way = ways_[at];
        ways_[way.newer].older = way.older;
        ways_[way.older].newer = way.newer;
        const std::uint32_t second = newest_[set], oldest = ways_[second].newer;
        way.older = second;
        way.newer = oldest;
        ways_[second].newer = at;
        ways_[oldest].older = at;
        newest_[set] = at;
    }

    void unchain(std::uint32_t victim) {
        std::uint32_t* link = &chains_[bucket(ways_[victim].set, ways_[victim].line)];
        while (*link != victim) link = &ways_[*link].next;
        *link = ways_[victim].next;
    }

    int shift_;
    std::vector<Way> ways_;
    std::vector<std::uint32_t> newest_;
    std::vector<std::uint32_t> chains_;  ///< first way of each bucket
};

}  // namespace raycache::cachesim
