// What all caches of a functional replay share and none changes, and what a thread that simulates them works with.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "cachesim/cache/fill.hpp"
#include "cachesim/cache/line_ids.hpp"
#include "cachesim/cache/lookups.hpp"
#include "cachesim/cache/set_finder.hpp"
#include "cachesim/frontend/coalesce.hpp"
#include "cachesim/frontend/load_counter.hpp"
#include "cachesim/frontend/region_layout.hpp"
#include "cachesim/gpus/gpu.hpp"
#include "cachesim/instruction_set.hpp"
#include "cachesim/replay/request_sink.hpp"
#include "cachesim/replay/tally.hpp"
#include "traces/header.hpp"

namespace raycache::cachesim {

struct HierarchyRules {
    HierarchyRules(const Gpu&, const std::vector<traces::Region>&, InstructionSet);
    HierarchyRules(const HierarchyRules&) = delete;
    HierarchyRules& operator=(const HierarchyRules&) = delete;

    LineShape shape() const { return {gpu.l1().line_bytes, gpu.l1().sector_bytes}; }

    Gpu gpu;
    std::vector<traces::Region> regions;
    InstructionSet instructions;
    LineIds ids;
    LoadCounter count_loads;
    std::vector<SetFinder> find_sets;       ///< of each level
    std::vector<Fill> fills;                ///< likewise
    std::size_t shared;                     ///< the last level: one cache for all SMs
    std::vector<traces::ObjectKind> kinds;  ///< of each region
    bool writes = false, streams = false;   ///< any region is written, is streamed (traces::is_stream)
    std::size_t rounds;                     ///< of a window: every SM may run that far ahead of others
};

/// Where a warp access of a window comes from. The window has HierarchyRules::rounds of them for each SM.
struct AccessOrigin {
    std::uint32_t group;  ///< GroupNumbers
    std::uint16_t round;
    std::uint8_t region, l1;
};

/// What a thread works with, whichever SMs it simulates.
struct Workspace {
    /// Where lines are numbered as they are touched (LineIds::dense()), only one thread may run.
    explicit Workspace(HierarchyRules& rules)
        : tally(rules.regions.size() + 1), coalesce(rules.regions, rules.shape(), rules.ids, rules.instructions) {}

    Tally tally;  ///< of all that this thread simulated

    // Of no interest between calls.
    Coalescer coalesce;
    Lookups lookups, written;
    std::vector<std::uint32_t> sets;     ///< of look-ups
    std::vector<std::uint32_t> sectors;  ///< of accesses
    std::vector<std::uint32_t> asked;    ///< sectors asked for, while a level answers
    std::vector<ServedRequest> served;
};

}  // namespace raycache::cachesim
