// Least recently used, for many ways: a hash table finds the line, a ring of the set's ways keeps the order of last
// use. Every look-up takes constant time, whatever the associativity.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <vector>

#include "cachesim/cache/line_fills.hpp"

namespace raycache::cachesim {

/// `Place` holds every way of one set and one more. A set is self-contained: the smaller a place is, the more of it
/// stays in the caches of the machine.
template <class Place>
class LruManyWays {
public:
    LruManyWays(std::uint64_t sets, std::uint64_t ways, unsigned /*sectors_per_line*/)
        : ways_per_set_(ways),
          chains_per_set_(std::bit_ceil(2 * ways)),
          shift_(64 - static_cast<int>(std::bit_width(chains_per_set_ - 1))),
          ways_(sets * ways),
          newest_(sets),
          chains_(sets * chains_per_set_, none) {
        for (std::size_t i = 0; i < ways_.size(); ++i) {
            ways_[i].older = static_cast<Place>((i % ways + 1) % ways);
            ways_[i].newer = static_cast<Place>((i % ways + ways - 1) % ways);
        }
    }

    void prefetch(std::uint64_t set, std::uint32_t line) const {
        __builtin_prefetch(&chains_[set * chains_per_set_ + bucket(line)]);
        __builtin_prefetch(&newest_[set], 1);
    }

    std::uint32_t access(std::uint64_t set, std::uint32_t line, std::uint32_t sectors) {
        Way* const ways = &ways_[set * ways_per_set_];
        Place* const chains = &chains_[set * chains_per_set_];
        Place& newest = newest_[set];
        Place& chain = chains[bucket(line)];
        for (Place at = chain; at != none; at = ways[at].next) {
            Way& way = ways[at];
            if (way.line != line) continue;
            const std::uint32_t missing = sectors & ~way.sectors;
            way.sectors |= sectors;
            if (at != newest) make_newest(ways, newest, at);
            return missing;
        }
        // The oldest way of the ring stands just before the newest: turning the ring by one evicts it.
        const Place victim = ways[newest].newer;
        Way& way = ways[victim];
        ++fills_.line_misses;
        if (way.sectors) {
            Place* link = &chains[bucket(way.line)];
            while (*link != victim) link = &ways[*link].next;
            *link = way.next;
        } else {
            ++fills_.of_empty_ways;
        }
        newest = victim;
        way.line = line;
        way.sectors = sectors;
        way.next = chain;
        chain = victim;
        return sectors;
    }

    LineFills fills() const { return fills_; }

private:
    static constexpr Place none = static_cast<Place>(~Place{0});
    struct Way {
        std::uint32_t line = 0;
        std::uint32_t sectors = 0;   ///< 0: empty, in no chain
        Place older = 0, newer = 0;  ///< the ring of the set; the newest's `newer` is the oldest
        Place next = none;           ///< the chain of the bucket
    };

    /// Multiplicative hashing (Knuth, The Art of Computer Programming 3, section 6.4).
    std::uint64_t bucket(std::uint64_t line) const { return (line * 0x9e3779b97f4a7c15ull) >> shift_; }

    static void make_newest(Way* ways, Place& newest, Place at) {
        Way& way = ways[at];
        ways[way.newer].older = way.older;
        ways[way.older].newer = way.newer;
        const Place second = newest, oldest = ways[second].newer;
        way.older = second;
        way.newer = oldest;
        ways[second].newer = at;
        ways[oldest].older = at;
        newest = at;
    }

    std::uint64_t ways_per_set_, chains_per_set_;
    int shift_;
    std::vector<Way> ways_;
    std::vector<Place> newest_;
    std::vector<Place> chains_;  ///< first way of each bucket of each set
    LineFills fills_;
};

}  // namespace raycache::cachesim
