#include "cachesim/replay/statistics.hpp"

namespace raycache::cachesim {

Counters& Counters::operator+=(const Counters& other) {
    rays += other.rays;
    steps += other.steps;
    lane_accesses += other.lane_accesses;
    warp_accesses += other.warp_accesses;
    loads += other.loads;
    requests += other.requests;
    for (std::size_t level = 0; level < most_levels; ++level) {
        levels[level].sectors += other.levels[level].sectors;
        levels[level].hits += other.levels[level].hits;
    }
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
