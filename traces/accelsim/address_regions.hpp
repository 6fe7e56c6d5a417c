// Regions of the trace format for objects of one size that lie anywhere in memory.
//
// A region's elements lie at base + i * stride, the base is a multiple of 2 MiB, and the stride is at least the size.
// So not every set of addresses can be told: objects of 48 B at multiples of 16 overlap, and no region has them.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "traces/header.hpp"

namespace raycache::traces {

/// Where a region's first and last element in use lie.
struct CoveredRange {
    std::uint64_t first = 0, last = 0;
    Region region;
};

/// Regions (kind node) that together have an element at each address, as few as possible. `addresses`: ascending,
/// distinct, below 2^48; `size`: 1 to 4096. Objects whose size is no power of two begin a new region after a gap of
/// 16 MiB, since different arrays of them seldom fit one. Throws Error if no region can have them; it names `file`.
std::vector<CoveredRange> cover(const std::vector<std::uint64_t>& addresses, std::uint32_t size,
                                const std::string& file);

}  // namespace raycache::traces
