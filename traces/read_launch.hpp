// The warps of one launch of a trace file, one after the other.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "traces/reader.hpp"

namespace raycache::traces {

/// Calls use(WarpTrace&&) for each warp of the launch in order. Thread-safe. Throws Error as Reader::read_block() does.
template <class Use>
void read_launch(const Reader& reader, std::uint32_t launch, Use&& use) {
    const auto& blocks = reader.blocks();
    const auto begin =
        std::partition_point(blocks.begin(), blocks.end(), [&](const BlockInfo& b) { return b.launch < launch; });
    std::vector<WarpTrace> warps;
    for (auto b = begin; b != blocks.end() && b->launch == launch; ++b) {
        reader.read_block(static_cast<std::size_t>(b - blocks.begin()), warps);
        for (WarpTrace& warp : warps) use(std::move(warp));
    }
}

}  // namespace raycache::traces
