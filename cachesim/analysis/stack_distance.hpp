// LRU stack distances: how many ways a cache would have had to have for each look-up to hit, for all numbers of ways at
// once (Mattson, Gecsei, Slutz, Traiger 1970, "Evaluation techniques for storage hierarchies"; of a cache with sets,
// set by set: Hill & Smith 1989, "Evaluating associativity in CPU caches").
//
// The distance of a line is the number of other lines of its set looked up since it was last; a cache of W ways with
// LRU holds it if that is less than W. Sectors are fetched one by one, or in aligned groups: one is there if its line
// has never been evicted since it was fetched, so its distance is the largest of its line since it was last asked for.
// Exact for any sequence of look-ups and, with one set, equal to ShadowCache of W lines.
//
// Memory, about 30 bytes a line and 4 a sector, grows with the highest line; bytes() says it.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <vector>

#include "cachesim/analysis/recency_order.hpp"

namespace raycache::cachesim {

/// How many sectors were asked for at each distance.
class DistanceCounts {
public:
    void add(std::uint64_t distance, std::uint64_t sectors) {
        if (distance >= by_distance_.size()) [[unlikely]]
            by_distance_.resize(distance + 1 + distance / 2);
        by_distance_[distance] += sectors;
        asked_ += sectors;
    }
    /// For the first time.
    void add_first(std::uint64_t sectors) { asked_ += sectors; }

    std::uint64_t asked() const { return asked_; }
    /// Of a cache with that number of ways; with one set, of lines.
    std::uint64_t hits(std::uint64_t ways) const {
        std::uint64_t sum = 0;
        for (std::uint64_t d = 0; d < std::min<std::uint64_t>(ways, by_distance_.size()); ++d) sum += by_distance_[d];
        return sum;
    }
    /// hits() of 0, 1, 2 … ways; more than the last number have no more.
    std::vector<std::uint64_t> hits_by_ways() const {
        std::vector<std::uint64_t> all{0};
        std::size_t size = by_distance_.size();
        while (size > 0 && by_distance_[size - 1] == 0) --size;
        for (std::size_t d = 0; d < size; ++d) all.push_back(all.back() + by_distance_[d]);
        return all;
    }

private:
    std::vector<std::uint64_t> by_distance_;
    std::uint64_t asked_ = 0;
};

class StackDistance {
public:
    /// `sectors`: of a line, 1 to 32. `fill_sectors`: a power of two; a miss fetches the aligned group of this many
    /// sectors that holds the missing one.
    explicit StackDistance(unsigned sectors, unsigned fill_sectors = 1, std::size_t sets = 1)
        : sectors_(sectors), fill_sectors_(fill_sectors), orders_(sets) {}

    /// Of a sector that was never fetched.
    static constexpr std::uint32_t never = ~std::uint32_t{0};

    /// The next look-up: some sectors of one line; lines are numbered from 0 without large gaps (LineIds), through all
    /// sets. Calls each(distance, sector) for each of them, lowest first. A line is always looked up in the same set.
    template <class Each>
    void look_up(std::uint32_t line, std::uint32_t asked, Each&& each, std::size_t set = 0) {
        if (sectors_ == 4)
            look_up_in<4>(line, asked, each, set);
        else
            look_up_in<0>(line, asked, each, set);
    }

    /// The next look-up but a few is of this line.
    void prefetch(std::uint32_t line) const {
        const std::size_t at = std::size_t{line} * (2 + sectors_);
        if (at < lines_.size()) __builtin_prefetch(&lines_[at]);
    }

    /// Lines looked up so far.
    std::uint32_t lines() const {
        std::uint32_t sum = 0;
        for (const RecencyOrder& order : orders_) sum += order.lines();
        return sum;
    }
    /// Memory that it takes.
    std::size_t bytes() const {
        std::size_t sum = lines_.capacity() * sizeof(lines_[0]) + orders_.capacity() * sizeof(orders_[0]);
        for (const RecencyOrder& order : orders_) sum += order.bytes();
        return sum;
    }
    /// All sectors that are fetched with these.
    std::uint32_t with_group(std::uint32_t sectors) const {
        if (fill_sectors_ == 1) return sectors;
        std::uint32_t all = 0;
        for (unsigned first = 0; first < sectors_; first += fill_sectors_) {
            const auto group = static_cast<std::uint32_t>(((std::uint64_t{1} << fill_sectors_) - 1) << first);
            if (sectors & group) all |= group;
        }
        return all;
    }

private:
    /// `Sectors`: those of a line, 0 where the compiler need not know.
    template <unsigned Sectors, class Each>
    void look_up_in(std::uint32_t line, std::uint32_t asked, Each& each, std::size_t set) {
        const unsigned sectors = Sectors ? Sectors : sectors_;
        const std::size_t stride = 2 + sectors, at = std::size_t{line} * stride;
        if (at >= lines_.size()) [[unlikely]]
            lines_.resize((std::size_t{line} + 1 + line / 2) * stride);
        std::uint32_t* const found = &lines_[at];
        std::uint32_t& time = found[0];
        std::uint32_t& fetched = found[1];
        std::uint32_t* const farthest = found + 2;
        RecencyOrder& order = orders_[set];
        if (const std::uint32_t distance = time == 0 ? 0 : order.later(time))
            for (unsigned s = 0; s < sectors; ++s) farthest[s] = std::max(farthest[s], distance);
        for (std::uint32_t left = asked; left; left &= left - 1) {
            const auto sector = static_cast<unsigned>(std::countr_zero(left));
            each(fetched >> sector & 1 ? farthest[sector] : never, sector);
        }
        const std::uint32_t filled = with_group(asked);
        fetched |= filled;
        for (std::uint32_t left = filled; left; left &= left - 1) farthest[std::countr_zero(left)] = 0;
        time = order.touch(line, time, [&](std::uint32_t l, std::uint32_t t) { lines_[l * stride] = t; });
    }

    unsigned sectors_, fill_sectors_;
    /// By line: the time of its last look-up, from 1, 0 for none; which sectors were fetched, ever; of each sector, the
    /// largest distance since it was last asked for.
    std::vector<std::uint32_t> lines_;
    std::vector<RecencyOrder> orders_;  ///< by set
};

}  // namespace raycache::cachesim
