#include "tools/jobs/sensitivity/read_values.hpp"

#include <algorithm>

#include "traces/object_kind.hpp"
#include "traces/record.hpp"

namespace raycache::tools {
namespace {

using cachesim::Gpu;

/// Kinds of visits that traces of these regions can have, as visit_instructions() tells them apart.
struct Visits {
    bool node = false, node4 = false, node8 = false, triangle = false, texel = false;

    explicit Visits(const std::vector<traces::Region>& regions) {
        for (const traces::Region& region : regions) switch (traces::role_of(region.kind).charge) {
                case traces::Charge::node:
                    (region.degree <= 2 ? node : region.degree <= 4 ? node4 : node8) = true;
                    break;
                case traces::Charge::triangle:
                    triangle = true;
                    break;
                case traces::Charge::texel:
                    texel = true;
                    break;
            }
    }
};

void clear_timing(cachesim::Timing& t, const Gpu& gpu, const Visits& visits) {
    if (!visits.node) t.node_instructions = 0;
    if (!visits.node4) t.node4_instructions = 0;
    if (!visits.node8) t.node8_instructions = 0;
    if (!visits.triangle) t.triangle_instructions = t.leaf_instructions = 0;
    if (!visits.texel) t.texel_instructions = 0;
    if (t.l1_port == cachesim::L1Port::tags) t.l1_banks = 1;
    const cachesim::FrontEnd& front = gpu.front_end;
    const std::uint32_t all = traces::warp_lanes;  // a group of all lanes is never empty
    if (std::min({front.lanes_per_request_16, front.lanes_per_request_8, front.lanes_per_request_4}) == all)
        t.empty_request_cycles = 0;
}

}  // namespace

Gpu as_replayed(Gpu gpu, const std::vector<traces::Region>& regions) {
    gpu.name.clear();
    gpu.description.clear();
    gpu.changes.clear();
    gpu.max_warps_per_sm = 0;
    if (gpu.traversal == cachesim::Traversal::software) gpu.rt_unit.reset();
    if (gpu.timing) clear_timing(*gpu.timing, gpu, Visits(regions));
    for (cachesim::CacheGeometry& level : gpu.levels) {
        if (level.policy != "random") level.seed = 1;
        if (level.slices == 1) level.slice_hash = cachesim::SliceHash::modulo;
    }
    return gpu;
}

}  // namespace raycache::tools
