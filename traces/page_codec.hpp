// Page tables of regions with gaps (page_table.hpp) on disk. Internal to traces/.
#pragma once

#include <cstdint>
#include <span>

#include "traces/bytes.hpp"
#include "traces/fault.hpp"
#include "traces/header.hpp"
#include "traces/memory_budget.hpp"

namespace raycache::traces {

/// The rules of a region with pages that need no table. `at` is the offset of the region's entry.
void check_paged(const Region&, unsigned index, const Origin& at);

/// Pages that the region's elements lie in, in a row.
std::uint64_t pages_of(const Region&);

/// Appends the region's table. Throws Error if it is not ascending or not as long as pages_of() says, or if an element
/// ends beyond 2^64 - 1.
void encode_pages(const Region&, unsigned index, const Origin&, Bytes& out);

/// Reads the table of a region that check_paged() let pass from the front of `stored`; returns the bytes it takes.
std::uint64_t decode_pages(Region&, unsigned index, std::span<const std::uint8_t> stored, const Origin&, MemoryBudget&);

}  // namespace raycache::traces
