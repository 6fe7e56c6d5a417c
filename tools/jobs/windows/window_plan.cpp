#include "tools/jobs/windows/window_plan.hpp"

#include <algorithm>
#include <bit>
#include <unordered_set>

#include "tracer/sampling/random_stream.hpp"
#include "traces/shuffle.hpp"

namespace raycache::tools {
namespace {

using tracer::HashPurpose;
using tracer::RandomStream;

/// Fewer blocks than this leave an interval nothing to stand on: then blocks are shorter.
constexpr std::uint64_t least_blocks = 8;

/// Launches of a block of at most `wanted` launches out of `all`.
std::uint32_t block_length(std::uint64_t all, std::uint32_t wanted) {
    std::uint32_t length = std::bit_floor(std::max(wanted, 1U));
    while (length > 1 && all / length < least_blocks) length /= 2;
    return length;
}

/// `count` places, one in each of as many parts of the launch, dealt out evenly to the launches of a block. Each begins
/// at a multiple of `grain` warps.
std::vector<WindowPlace> stratified(RandomStream& random, std::uint32_t count, std::uint32_t launches,
                                    std::uint32_t warps, std::uint32_t grain) {
    constexpr std::uint64_t unit = 1U << 16;
    const std::uint64_t grains = (warps + grain - 1) / grain;
    std::vector<WindowPlace> places;
    std::uint64_t turn = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
        if (i % launches == 0) turn = random.below(launches);
        const std::uint64_t at = (i * unit + random.below(unit)) * grains / (count * unit);
        places.push_back({static_cast<std::uint32_t>((i + turn) % launches), static_cast<std::uint32_t>(at) * grain});
    }
    return places;
}

}  // namespace

WindowPlan::WindowPlan(std::uint64_t spp, std::uint32_t warps, std::uint32_t indices_per_launch, std::uint64_t seed,
                       const WindowSizes& sizes, std::uint32_t grain)
    : seed_(seed), sizes_(sizes), warps_(warps) {
    if (grain == 0) grain = indices_per_launch;
    const std::uint64_t all = std::max<std::uint64_t>(1, spp / grain);
    const std::uint32_t length = block_length(all, sizes.indices / grain);
    blocks_ = all / length;
    block_indices_ = static_cast<std::uint32_t>(std::min<std::uint64_t>(std::uint64_t{length} * grain, spp));
    indices_per_launch_ = std::min(indices_per_launch, block_indices_);
    launches_ = block_indices_ / indices_per_launch_;
}

std::vector<std::uint32_t> WindowPlan::draw(std::size_t count) const {
    RandomStream random(seed_, HashPurpose::window_blocks);
    std::vector<std::uint32_t> first;
    std::unordered_set<std::uint64_t> drawn;
    while (first.size() < count) {
        if (drawn.size() == blocks_) drawn.clear();
        const std::uint64_t block = random.below(blocks_);
        if (!drawn.insert(block).second) continue;
        first.push_back(static_cast<std::uint32_t>(block * block_indices_));
    }
    return first;
}

BlockPlan WindowPlan::block(std::size_t number, std::uint32_t first) const {
    RandomStream random(seed_, HashPurpose::window_places, static_cast<std::uint32_t>(number));
    BlockPlan plan;
    plan.first = first;
    plan.work = stratified(random, sizes_.work_groups, launches_, warps_, sizes_.work_warps);
    plan.sm_windows = stratified(random, sizes_.sm_windows, launches_, warps_, sizes_.work_warps);
    plan.windows = stratified(random, sizes_.windows, launches_, warps_, sizes_.work_warps);
    plan.fills = stratified(random, sizes_.fill_waves, launches_, warps_, sizes_.work_warps);
    // Neighbours in the list lie side by side in the picture: a random order makes any first ones a random choice.
    const auto shuffle = [&](std::vector<WindowPlace>& places) {
        shuffle_by(places, [&](std::size_t n) { return random.below(n); });
    };
    shuffle(plan.sm_windows);
    shuffle(plan.windows);
    shuffle(plan.fills);
    return plan;
}

}  // namespace raycache::tools
