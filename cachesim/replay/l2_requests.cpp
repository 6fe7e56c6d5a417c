#include "cachesim/replay/l2_requests.hpp"

#include <algorithm>
#include <cmath>

namespace raycache::cachesim {

namespace {

/// Lanes of all loads of accesses that have so many lanes together: each access of a kind is as many loads.
std::uint64_t lanes_of_loads(const Counters& c) {
    if (c.warp_accesses == 0) return 0;
    if (c.loads % c.warp_accesses == 0) return c.lane_accesses * (c.loads / c.warp_accesses);
    // Regions of one kind that are read by different numbers of loads: as if each had the same share of the lanes.
    const double loads = static_cast<double>(c.loads) / static_cast<double>(c.warp_accesses);
    return static_cast<std::uint64_t>(std::llround(static_cast<double>(c.lane_accesses) * loads));
}

}  // namespace

L2RequestCounter::L2RequestCounter(const Gpu& gpu, const std::vector<traces::Region>& regions)
    : shared_(gpu.levels.size() - 1),
      loads_(regions, gpu.front_end, LineShape(gpu.l1().line_bytes, gpu.l1().sector_bytes)) {}

void L2RequestCounter::issued(std::span<const IssuedAccess> accesses) {
    for (const IssuedAccess& a : accesses) {
        if (a.number >= accesses_.size()) accesses_.resize(a.number + 1);
        Access& access = accesses_[a.number];
        access.mask = a.record.mask;
        access.region = a.record.region;
        std::copy_n(a.elements, a.record.lanes(), access.elements.begin());
    }
}

void L2RequestCounter::served(std::size_t /*level*/, std::span<const ServedRequest> requests) {
    for (const ServedRequest& r : requests) {
        const Access& access = accesses_[r.access];
        requests_[static_cast<unsigned>(r.ray)][r.bounce][static_cast<unsigned>(r.kind)] +=
            loads_.line_requests(access.region, access.mask, access.elements.data(), r.address, r.asked);
    }
}

LaunchStatistics L2RequestCounter::in_instructions(const LaunchStatistics& counted) const {
    LaunchStatistics launch = counted;
    for (RayGroup& group : launch.groups) {
        const auto& requests = requests_[static_cast<unsigned>(group.ray)][group.bounce];
        for (std::size_t kind = 0; kind < group.by_kind.size(); ++kind) {
            Counters& c = group.by_kind[kind];
            if (c.loads == 0) continue;  // what a sort moves
            c.lane_accesses = lanes_of_loads(c);
            c.warp_accesses = c.loads;
            c.requests = requests[kind];
        }
    }
    return launch;
}

}  // namespace raycache::cachesim
