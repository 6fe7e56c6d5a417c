// Where the windows of an estimate lie: blocks of sample indices, and places in the picture for each.
//
// A block is a run of 2^m neighbouring sample indices that begins at a multiple of 2^m. Of a Sobol sequence, and of all
// sequences that are nets in base 2, it is a net of its own, so its points cover the domain as evenly as so few can: a
// block scatters far less than as many indices drawn one by one. Blocks are drawn without replacement until all have
// been drawn, then anew; places are drawn anew for each. So results of blocks are independent of one another, which
// makes the block the unit of intervals.
//
// Places are stratified: the picture, in launch order, is cut into as many equal parts as there are places, each gets
// one, at random within it; and each index of the block gets as many of them as any other.
//
// All places are of as many warps, and so of as many paths, whatever the thread map: 256 paths at a place of work are a
// square of 256 pixels, 256 pixels of a row, or 32 sample indices of 8 pixels.
#pragma once

#include <cstdint>
#include <vector>

namespace raycache::tools {

/// How large everything is: docs/estimates.md says what was weighed.
struct WindowSizes {
    std::uint32_t indices = 64;        ///< of a block, at most
    std::uint32_t work_groups = 256;   ///< of work_warps each, traced and not replayed
    std::uint32_t work_warps = 8;      ///< neighbouring warps: a square of 16x16 pixels
    std::uint32_t sm_windows = 128;    ///< of one SM: its CTAs alone; fewer where it holds several CTAs at once
    std::uint32_t windows = 8;         ///< of the whole GPU
    std::uint32_t timed_windows = 2;   ///< of these, in time
    double warm_up_waves = 1;          ///< before each window, not counted
    double timed_warm_up_waves = 0.5;  ///< of those in time
    double counted_waves = 1;          ///< a wave: the warps that a GPU holds at once
    std::uint32_t fill_waves = 8;      ///< at most, before the first window, until the last cache is full
    double unfilled_share = 0.005;     ///< of the last cache's misses that find an empty way: below it, it is full
};

/// A warp in the stream of a block's launches.
struct WindowPlace {
    std::uint32_t index = 0;  ///< which sample index of the block, from 0
    std::uint32_t warp = 0;   ///< of its launch
};

struct BlockPlan {
    std::uint32_t first = 0;                       ///< first sample index
    std::vector<WindowPlace> work;                 ///< where each traced group begins
    std::vector<WindowPlace> sm_windows, windows;  ///< where each counted part begins
    std::vector<WindowPlace> fills;                ///< where each wave that fills the last cache begins
};

class WindowPlan {
public:
    /// `spp`: N. `warps`: of a launch, which has `indices_per_launch` sample indices. `grain`: blocks are of multiples
    /// of so many indices (0: of as many as a launch has), so that strategies whose launches differ can have the same
    /// blocks. Throws nothing.
    WindowPlan(std::uint64_t spp, std::uint32_t warps, std::uint32_t indices_per_launch, std::uint64_t seed,
               const WindowSizes& = {}, std::uint32_t grain = 0);

    /// Launches of a block: of neighbouring sample indices, indices_per_launch each.
    std::uint32_t launches() const { return launches_; }
    /// Different blocks that there are.
    std::uint64_t blocks() const { return blocks_; }
    /// Below N: N may be less than what a launch has room for.
    std::uint32_t indices_per_launch() const { return indices_per_launch_; }

    /// The first sample index of each of the first `count` blocks that are drawn.
    std::vector<std::uint32_t> draw(std::size_t count) const;
    /// The places of drawn block number `number`, whose first sample index is `first`.
    BlockPlan block(std::size_t number, std::uint32_t first) const;

private:
    std::uint64_t seed_;
    WindowSizes sizes_;
    std::uint32_t warps_, indices_per_launch_, launches_;
    std::uint64_t blocks_;
    std::uint32_t block_indices_;
};

}  // namespace raycache::tools
