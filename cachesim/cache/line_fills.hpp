// How often caches took in a line, and how often a way that was still empty: how far they are warm.
#pragma once

#include <cstdint>

namespace raycache::cachesim {

struct LineFills {
    std::uint64_t line_misses = 0;    ///< look-ups of a line that was in no way of its set
    std::uint64_t of_empty_ways = 0;  ///< line misses that took a way that had held nothing since the start

    LineFills& operator+=(const LineFills& other) {
        line_misses += other.line_misses;
        of_empty_ways += other.of_empty_ways;
        return *this;
    }
    bool operator==(const LineFills&) const = default;
};

}  // namespace raycache::cachesim
