// The warps of one launch of a trace file, one after the other.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "traces/reader.hpp"

namespace raycache::traces {

/// The blocks of a launch among Reader::blocks(): the first, and the one behind the last.
inline std::pair<std::size_t, std::size_t> blocks_of(const Reader& reader, std::uint32_t launch) {
    const auto& blocks = reader.blocks();
    const auto begin =
        std::partition_point(blocks.begin(), blocks.end(), [&](const BlockInfo& b) { return b.launch < launch; });
    const auto end = std::partition_point(begin, blocks.end(), [&](const BlockInfo& b) { return b.launch == launch; });
    return {static_cast<std::size_t>(begin - blocks.begin()), static_cast<std::size_t>(end - blocks.begin())};
}

/// Calls use(WarpTrace&&) for each warp of the launch in order. Thread-safe. Throws Error as Reader::read_block() does.
template <class Use>
void read_launch(const Reader& reader, std::uint32_t launch, Use&& use) {
    const auto [begin, end] = blocks_of(reader, launch);
    std::vector<WarpTrace> warps;
    for (std::size_t block = begin; block != end; ++block) {
        reader.read_block(block, warps);
        for (WarpTrace& warp : warps) use(std::move(warp));
    }
}

}  // namespace raycache::traces
