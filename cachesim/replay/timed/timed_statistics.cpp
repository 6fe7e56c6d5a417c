#include "cachesim/replay/timed/timed_statistics.hpp"

#include <initializer_list>

namespace raycache::cachesim {

TimedStatistics& TimedStatistics::operator+=(const TimedStatistics& other) {
    cycles += other.cycles;
    seconds += other.seconds;
    rays += other.rays;
    warp_accesses += other.warp_accesses;
    lane_accesses += other.lane_accesses;
    instructions += other.instructions;
    loads += other.loads;
    l1 += other.l1;
    l2 += other.l2;
    l3 += other.l3;
    dram_sectors += other.dram_sectors;
    visit_cycles += other.visit_cycles;
    for (const auto resource : {&TimedStatistics::issue, &TimedStatistics::l1_port, &TimedStatistics::crossbar,
                                &TimedStatistics::l2_slices, &TimedStatistics::dram}) {
        (this->*resource).busy += (other.*resource).busy;
        (this->*resource).copies = (other.*resource).copies;
    }
    return *this;
}

}  // namespace raycache::cachesim
