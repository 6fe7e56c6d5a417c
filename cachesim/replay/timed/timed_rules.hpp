// What all SMs of a timed replay share and none changes.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include "cachesim/cache/line_ids.hpp"
#include "cachesim/cache/line_map.hpp"
#include "cachesim/gpus/gpu.hpp"
#include "cachesim/replay/timed/leaf_starts.hpp"
#include "cachesim/replay/timed/visit.hpp"
#include "traces/header.hpp"

namespace raycache::cachesim {

/// What may be switched off, to see what it costs.
struct Idealised {
    bool perfect_l1 = false;          ///< every look-up in L1 hits
    bool perfect_l2 = false;          ///< every look-up in the last level hits
    bool infinite_bandwidth = false;  ///< no port, crossbar, slice or channel is ever taken
    bool no_added_latency = false;    ///< all levels and DRAM answer as fast as L1
    bool full_warps = false;          ///< consecutive visits of a warp to objects of one kind fill up its lanes
};

/// How loads pass the ports of L1s: with the same results.
enum class PortPath {
    fast,  ///< what an earlier load of the visit found is not looked for again
    rule,  ///< every load by the rule for any load: what tests hold the fast path against
};

/// Instructions of a visit to an object beside its loads. `children`: of a node, as Region::degree says.
std::uint32_t visit_instructions(const Timing&, traces::ObjectKind, unsigned children);

struct TimedRules {
    /// `ids` number the lines of the regions and must outlive this object.
    TimedRules(const Gpu&, const std::vector<traces::Region>&, const LineIds& ids, const Idealised&,
               PortPath = PortPath::fast);

    bool three_levels() const { return gpu.levels.size() == 3; }
    /// Whether instructions go one by one through collectors. Where nothing is ever taken there is nothing to wait for.
    bool collectors() const { return timing.operand_collectors > 0 && !ideal.infinite_bandwidth; }
    bool rt_unit() const { return !tests.empty(); }
    /// How an SM loads the objects of a region, even if an RT unit would.
    const LoadShape& sm_shape(std::uint32_t region) const {
        return sm_shapes.empty() ? shapes[region] : sm_shapes[region];
    }
    /// Of one visit.
    std::uint32_t most_loads() const {
        std::uint32_t most = 1;
        for (const LoadShape& shape : shapes) most = std::max(most, shape.loads);
        return most;
    }

    Gpu gpu;
    const LineIds& ids;
    Timing timing;
    Idealised ideal;
    PortPath path;
    std::vector<LineMap> maps;                ///< of each level
    std::vector<LoadShape> shapes;            ///< of each region
    std::vector<LoadShape> sm_shapes;         ///< where an RT unit visits, those of an SM that does; else none
    std::vector<std::uint32_t> instructions;  ///< of a visit to each region, without its loads
    /// Of the RT unit for each lane of a visit to each region; 0: the SM visits. Empty where software traverses.
    std::vector<std::uint32_t> tests;
    std::vector<bool> triangle;        ///< those tests are of a triangle each, not of boxes
    std::optional<LeafStarts> leaves;  ///< if they cost instructions of their own
    std::uint32_t sectors_per_line;
    int line_of_sector;  ///< log2 of it
    unsigned cta_slots;
    double tag_cost, data_cost;               ///< L1Port::tags: cycles of a line, and of a sector
    std::uint32_t port_sectors;               ///< of one cycle, if that is a whole number; else 0
    std::vector<std::uint32_t> fill_sectors;  ///< of each level: what a miss fetches, an aligned piece of the line
};

}  // namespace raycache::cachesim
