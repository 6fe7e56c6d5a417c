// What travels from the front end through the cache levels: tag look-ups, each of one line of one warp access and the
// sectors of it that are wanted.
//
// One array for each field, so that vector instructions take many look-ups at a time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "cachesim/instruction_set.hpp"

namespace raycache::cachesim {

struct Lookups {
    std::vector<std::uint32_t> lines;     ///< LineIds
    std::vector<std::uint32_t> sectors;   ///< bit s = sector s of the line; 0 only in an answer
    std::vector<std::uint32_t> accesses;  ///< on whose behalf: number of the warp access in its window
    std::size_t count = 0;

    /// Makes room for `more` beside those there are, and a vector behind them. What lies beyond `count` is garbage.
    void reserve(std::size_t more) {
        if (lines.size() - count >= more + longest_vector) [[likely]]
            return;
        const std::size_t size = 2 * (count + more) + longest_vector;
        lines.resize(size);
        sectors.resize(size);
        accesses.resize(size);
    }
    /// Keeps the look-ups for which something was fetched; their order stays.
    void drop_answered(InstructionSet);
    /// There must be room.
    void add(std::uint32_t line, std::uint32_t wanted, std::uint32_t access) {
        lines[count] = line;
        sectors[count] = wanted;
        accesses[count] = access;
        ++count;
    }

private:
    static constexpr std::size_t longest_vector = 16;
};

}  // namespace raycache::cachesim
