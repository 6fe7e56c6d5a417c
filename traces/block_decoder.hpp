// From the bytes of a block back to its warps. Internal to traces/.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "traces/block_format.hpp"
#include "traces/header.hpp"
#include "traces/memory_budget.hpp"
#include "traces/record.hpp"

namespace raycache::traces {

/// Checks the checksum, decodes every record and replaces `out`. Throws Error, naming the block's offset, for anything
/// that the format does not allow, and where the budget has no room for what its head asks for.
BlockHead decode_block(const Header&, std::span<const std::uint8_t> block, const Origin&, const MemoryBudget&,
                       std::vector<WarpTrace>& out);

}  // namespace raycache::traces
