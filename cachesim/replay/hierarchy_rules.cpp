#include "cachesim/replay/hierarchy_rules.hpp"

#include <algorithm>

namespace raycache::cachesim {

namespace {

/// Enough that an SM finds its L1s in the machine's caches most of the time; few enough that the misses of a window
/// stay there, too.
constexpr std::size_t accesses_per_window = 32768;

}  // namespace

HierarchyRules::HierarchyRules(const Gpu& g, const std::vector<traces::Region>& r, InstructionSet set)
    : gpu(g),
      regions(r),
      instructions(set),
      ids(regions, gpu.l1().line_bytes),
      count_loads(regions, gpu.front_end, shape()),
      shared(gpu.levels.size() - 1),
      rounds(std::clamp<std::size_t>(accesses_per_window / gpu.sms, 8, 2048)) {
    for (const CacheGeometry& level : gpu.levels) {
        find_sets.emplace_back(level, ids, instructions);
        fills.emplace_back(level);
    }
    for (const traces::Region& region : regions) {
        kinds.push_back(region.kind);
        writes |= traces::is_write(region.kind);
        streams |= traces::is_stream(region.kind);
    }
}

}  // namespace raycache::cachesim
