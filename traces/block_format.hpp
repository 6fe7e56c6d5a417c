// The fixed head of a block. Internal to traces/.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "traces/bytes.hpp"
#include "traces/fault.hpp"
#include "traces/format.hpp"
#include "traces/record.hpp"

namespace raycache::traces {

struct BlockHead {
    std::uint32_t bytes = 0;  ///< of the block, head and checksum included
    std::uint32_t launch = 0, first_warp = 0, warps = 0;
    std::uint64_t records = 0, lane_accesses = 0, rays = 0;
    struct Size {
        std::uint32_t raw = 0, stored = 0;
    };
    std::array<Size, format::streams> sizes{};
};

void store_block_head(const BlockHead&, std::uint8_t* to);

/// Reads and bounds the head at the front of `block`, of a trace with issue steps or without. Does not look at the
/// checksum.
BlockHead parse_block_head(std::span<const std::uint8_t> block, bool issue, const Origin&);

}  // namespace raycache::traces
