// Which sectors a GPU has held since a launch began, so that those that come from DRAM for the first time can be told
// from those that come again.
#pragma once

#include <bit>
#include <cstdint>
#include <vector>

namespace raycache::cachesim {

class FirstTouches {
public:
    /// `sectors_per_line`: a power of two, at most 32.
    explicit FirstTouches(std::uint32_t sectors_per_line)
        : shift_(static_cast<unsigned>(std::countr_zero(sectors_per_line))) {}

    /// Sectors of a line (LineIds) come in. Returns those that never did before.
    std::uint32_t add(std::uint32_t line, std::uint32_t sectors) {
        const std::uint64_t bit = std::uint64_t{line} << shift_;
        const std::size_t word = bit / 32;
        const unsigned place = bit % 32;
        if (word >= held_.size()) held_.resize(2 * word + 1);
        const std::uint32_t first = (sectors << place) & ~held_[word];
        held_[word] |= first;
        return first >> place;
    }

private:
    unsigned shift_;                   ///< log2 of the sectors of a line
    std::vector<std::uint32_t> held_;  ///< a bit for each sector, line after line
};

}  // namespace raycache::cachesim
