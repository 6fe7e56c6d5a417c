#include "cachesim/analysis/l2_requests.hpp"

namespace raycache::cachesim {

L2RequestCounter::L2RequestCounter(const Gpu& gpu, const std::vector<traces::Region>& regions)
    : shared_(gpu.levels.size() - 1),
      loads_(regions, gpu.front_end, LineShape(gpu.l1().line_bytes, gpu.l1().sector_bytes)),
      log_(regions, gpu.l1().line_bytes, gpu.l1().sector_bytes) {
    for (const traces::Region& region : regions) kinds_.push_back(region.kind);
}

void L2RequestCounter::issued(std::span<const IssuedAccess> accesses) {
    for (const IssuedAccess& a : accesses) {
        log_.add(a);
        const traces::Record& record = a.record;
        of(record.ray, record.bounce, kinds_[record.region]).lanes +=
            std::uint64_t{loads_.loads(record.region)} * record.lanes();
    }
}

void L2RequestCounter::served(std::size_t /*level*/, std::span<const ServedRequest> requests) {
    for (const ServedRequest& r : requests) {
        const AccessLog::Access& access = log_[r.access];
        of(r.ray, r.bounce, r.kind).requests +=
            loads_.line_requests(access.region, access.mask, log_.elements(access), r.address, r.asked);
    }
}

LaunchStatistics L2RequestCounter::in_instructions(const LaunchStatistics& counted) const {
    LaunchStatistics launch = counted;
    for (RayGroup& group : launch.groups) {
        const auto& kinds = counts_[static_cast<unsigned>(group.ray)][group.bounce];
        for (std::size_t kind = 0; kind < group.by_kind.size(); ++kind) {
            Counters& c = group.by_kind[kind];
            if (c.loads == 0) continue;  // what a sort moves
            c.lane_accesses = kinds[kind].lanes;
            c.warp_accesses = c.loads;
            c.requests = kinds[kind].requests;
        }
    }
    return launch;
}

}  // namespace raycache::cachesim
