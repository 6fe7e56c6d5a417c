// The lines of a set, each in the way that it took when it came; `Order` says who goes. For policies that do not keep
// their lines in order of age: fifo, tree_plru, random.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "cachesim/cache/level.hpp"
#include "cachesim/cache/line_fills.hpp"

namespace raycache::cachesim {

/// A line takes the first empty way; only where none is empty is one evicted. `Order` offers
///     Order(sets, ways, …)
///     void use(set, way)                a line in this way was looked up or has just come
///     std::uint64_t victim(set)         the way to take next; all are full
template <class Order>
class WaysInPlace {
public:
    template <class... More>
    WaysInPlace(std::uint64_t sets, std::uint64_t ways, unsigned /*sectors_per_line*/, More&&... more)
        : ways_(ways),
          lines_(sets * ways),
          sectors_(sets * ways),
          used_(sets),
          order_(sets, ways, std::forward<More>(more)...) {}

    void prefetch(std::uint64_t set, std::uint32_t /*line*/) const {
        __builtin_prefetch(&used_[set]);
        __builtin_prefetch(&lines_[set * ways_]);
    }

    std::uint32_t access(std::uint64_t set, std::uint32_t line, std::uint32_t sectors) {
        const std::uint64_t first = set * ways_, used = used_[set];
        std::uint64_t way = find(&lines_[first], used, line);
        std::uint32_t present = 0;
        if (way < used) {
            present = sectors_[first + way];
        } else {
            ++fills_.line_misses;
            fills_.of_empty_ways += used < ways_;
            way = used < ways_ ? used_[set]++ : order_.victim(set);
            lines_[first + way] = line;
        }
        sectors_[first + way] = present | sectors;
        order_.use(set, way);
        return sectors & ~present;
    }

    LineFills fills() const { return fills_; }

private:
    /// The place of the line, or `count`. Compares eight at a time without a branch, so that vector instructions do it.
    static std::uint64_t find(const std::uint32_t* lines, std::uint64_t count, std::uint32_t line) {
        constexpr std::uint64_t run = 8;
        std::uint64_t at = 0;
        for (; at + run <= count; at += run) {
            bool any = false;
            for (std::uint64_t i = 0; i < run; ++i) any |= lines[at + i] == line;
            if (any) break;
        }
        while (at < count && lines[at] != line) ++at;
        return at;
    }

    std::uint64_t ways_;
    std::vector<std::uint32_t> lines_;
    std::vector<std::uint32_t> sectors_;
    std::vector<std::uint32_t> used_;  ///< by set: ways that are not empty, the first ones
    Order order_;
    LineFills fills_;
};

/// A level whose sets are WaysInPlace; `more` goes to Order.
template <class Order, class... More>
std::unique_ptr<Level> make_in_place(const CacheGeometry& geometry, CacheRange caches, More... more) {
    return std::make_unique<LevelWith<WaysInPlace<Order>>>(geometry, caches, more...);
}

}  // namespace raycache::cachesim
