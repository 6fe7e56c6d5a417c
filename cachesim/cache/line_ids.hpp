// A 32-bit numbering of the cache lines that a launch can touch.
//
// Regions lie far apart in the address space, but together they hold few lines. Numbered without the gaps, a line fits
// a 32-bit word, often together with its sectors, and a set of a cache fits few vector registers. Regions that share
// lines share ids. Where regions have 2^32 lines or more, or gaps (Region::pages), lines are numbered
// as they are first touched.
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "traces/header.hpp"

namespace raycache::cachesim {

class LineIds {
public:
    /// `line_bytes` must be a power of two. Throws Error if a region is impossible (empty elements, or its last byte
    /// above 2^64 - 1).
    LineIds(const std::vector<traces::Region>& regions, std::uint32_t line_bytes);

    /// Whether id = line - offset(region), modulo 2^64, and the lowest `equal_bits` bits of both are equal.
    bool dense() const { return dense_; }
    static constexpr unsigned equal_bits = 12;
    std::uint64_t offset(std::size_t region) const { return offsets_[region]; }

    /// Dense ids in ascending order: from `first` on, id = line - offset.
    struct Run {
        std::uint32_t first;
        std::uint64_t offset;
    };
    const std::vector<Run>& runs() const { return runs_; }

    /// Of a line (byte address / line size) of this region.
    std::uint32_t id(std::uint64_t line, std::size_t region) {
        if (dense_) [[likely]]
            return static_cast<std::uint32_t>(line - offsets_[region]);
        return number(line);
    }
    std::uint64_t line(std::uint32_t id, std::size_t region) const {
        return dense_ ? id + offsets_[region] : touched_[id];
    }

    /// Of any region; slower.
    std::uint64_t line(std::uint32_t id) const;

    /// Ids are below this, which is 2^32 - 1 at most.
    std::uint64_t bound() const { return bound_; }
    /// The highest line of all regions.
    std::uint64_t last_line() const { return last_line_; }

private:
    std::uint32_t number(std::uint64_t line);

    bool dense_ = true;
    std::uint64_t bound_ = 0, last_line_ = 0;
    std::vector<std::uint64_t> offsets_;
    std::vector<Run> runs_;
    std::unordered_map<std::uint64_t, std::uint32_t> numbers_;  ///< not dense: of the lines touched so far
    std::vector<std::uint64_t> touched_;                        ///< those lines
};

}  // namespace raycache::cachesim
