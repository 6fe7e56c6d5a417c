// A dense numbering of the cache lines that a launch can touch.
//
// Regions lie far apart in the address space, but together they hold few lines. Numbered without the gaps, a line fits
// a 32-bit word together with its sectors, and a set of a cache fits few vector registers. Regions that share lines
// share ids.
#pragma once

#include <cstdint>
#include <vector>

#include "traces/header.hpp"

namespace raycache::cachesim {

class LineIds {
public:
    /// `line_bytes` must be a power of two. Throws Error if a region is impossible (empty elements, or its last byte
    /// above 2^64 - 1).
    LineIds(const std::vector<traces::Region>& regions, std::uint32_t line_bytes);

    /// id of a line of this region = line number - offset(region), modulo 2^64.
    std::uint64_t offset(std::size_t region) const { return offsets_[region]; }

    /// Ids are below this.
    std::uint64_t count() const { return count_; }

private:
    std::vector<std::uint64_t> offsets_;
    std::uint64_t count_ = 0;
};

}  // namespace raycache::cachesim
