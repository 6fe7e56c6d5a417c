#include "cachesim/replay/statistics.hpp"

namespace raycache::cachesim {

Counters& Counters::operator+=(const Counters& other) {
    rays += other.rays;
    steps += other.steps;
    lane_accesses += other.lane_accesses;
    warp_accesses += other.warp_accesses;
    loads += other.loads;
    l1_requests += other.l1_requests;
    sectors += other.sectors;
    l1_hits += other.l1_hits;
    l2_sectors += other.l2_sectors;
    l2_hits += other.l2_hits;
    l3_sectors += other.l3_sectors;
    l3_hits += other.l3_hits;
    dram_sectors += other.dram_sectors;
    written_sectors += other.written_sectors;
    sort_sectors += other.sort_sectors;
    dram_first_sectors += other.dram_first_sectors;
    return *this;
}

Counters RayGroup::all() const {
    Counters sum;
    for (const Counters& kind : by_kind) sum += kind;
    sum.rays += rays;
    return sum;
}

Counters LaunchStatistics::all() const {
    Counters sum;
    for (const RayGroup& group : groups) sum += group.all();
    return sum;
}

}  // namespace raycache::cachesim
