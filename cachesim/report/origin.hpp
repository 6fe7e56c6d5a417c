// What the numbers of a series or a row are of, and which of them may be compared.
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "cachesim/analysis/counts.hpp"
#include "traces/error.hpp"
#include "traces/record.hpp"

namespace raycache::cachesim {

/// Where a series is an estimate of the steady state from windows (tools/jobs/windows): then each of its "launches" is
/// what one block of sample indices says of a launch of the whole picture, with full caches and nothing drained.
struct WindowSample {
    std::uint32_t blocks = 0;                      ///< drawn: the units of intervals
    std::uint32_t indices = 0;                     ///< neighbouring sample indices of each
    std::uint32_t windows = 0, timed_windows = 0;  ///< of each
    /// What intervals are wider by than those of one look: they hold in 95 % of all cases although the estimate was
    /// looked at several times, to see whether it is certain enough.
    double widening = 1;
    /// Of the last cache's misses, those that took a way that held nothing, on average over the blocks.
    double unfilled_share = 0;
    bool last_cache_full = true;  ///< in every block
    /// All N sample indices, launch after launch, are the one block: nothing was drawn, and every interval is nothing.
    bool all_indices = false;
};

struct Origin {
    std::string scene, strategy, sequence, parameters, thread_map, gpu;
    std::uint64_t spp = 0;                  ///< N
    CacheUnits caches;                      ///< of the GPU
    std::optional<WindowSample> windows{};  ///< none: whole launches, each from cold caches
    /// Sample indices of every pixel that each launch holds. Launches of as many can be paired one by one: thread maps
    /// then differ only in which of these paths share a warp, which is part of the strategy.
    std::uint32_t indices = 1;
};

/// Of a launch of a trace with that thread map (Provenance::thread_map): "samples" has 32 sample indices in a warp, all
/// others one.
inline std::uint32_t indices_per_launch(std::string_view thread_map) {
    return thread_map == "samples" ? traces::warp_lanes : 1;
}

/// What ratios refer to: a strategy, on the GPU of each row or, for variants of one GPU, on one of them.
struct Baseline {
    std::string strategy;  ///< empty: there are no ratios
    std::string gpu;       ///< empty: that of each row

    Baseline() = default;
    Baseline(std::string of_strategy, std::string on_gpu = {})
        : strategy(std::move(of_strategy)), gpu(std::move(on_gpu)) {}
    Baseline(const char* of_strategy) : strategy(of_strategy) {}

    bool empty() const { return strategy.empty(); }
    bool is(const Origin& o) const { return o.strategy == strategy && (gpu.empty() || o.gpu == gpu); }
    /// "cranley-patterson", "cranley-patterson on rtx-3070 (l1=128 KiB)"
    std::string name() const { return gpu.empty() ? strategy : strategy + " on " + gpu; }
    /// Whether `base` may be it for `of`: they differ in what a strategy is made of, or in `gpu`, and in nothing else.
    bool serves(const Origin& base, const Origin& of) const {
        const auto key = [](const Origin& o) { return std::tie(o.scene, o.sequence, o.spp); };
        return is(base) && key(base) == key(of) && (!gpu.empty() || base.gpu == of.gpu) && base.indices == of.indices;
    }
};

/// What `of` is compared with: the first of its baseline's, of its own thread map where there is one; null where there
/// is none. `same_part(other)`: whether both are of the same part of their launches.
template <class Item, class SamePart>
const Item* find_baseline(const std::vector<Item>& all, const Origin& of, const Baseline& baseline,
                          const SamePart& same_part) {
    const auto find = [&](bool same_map) -> const Item* {
        for (const Item& item : all)
            if (baseline.serves(item, of) && same_part(item) && (!same_map || item.thread_map == of.thread_map))
                return &item;
        return nullptr;
    };
    const Item* const same_map = find(true);
    return same_map ? same_map : find(false);
}

/// Throws UsageError if `baseline` was given by the user but is the strategy of none.
template <class Item>
void check_baseline(const std::vector<Item>& all, const Baseline& baseline) {
    std::set<std::string> names;
    for (const Item& item : all) names.insert(item.strategy);
    if (baseline.empty() || names.contains(baseline.strategy)) return;
    throw UsageError(fmt::format("baseline: expected one of the strategies {}, found \"{}\"", fmt::join(names, ", "),
                                 baseline.strategy));
}

}  // namespace raycache::cachesim
