#include "cachesim/replay/timed/timed_statistics.hpp"

#include <algorithm>
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
    warps += other.warps;
    warp_cycles += other.warp_cycles;
    warp_slots = other.warp_slots ? other.warp_slots : warp_slots;
    peak_l2_gb_s = std::max(peak_l2_gb_s, other.peak_l2_gb_s);
    peak_dram_gb_s = std::max(peak_dram_gb_s, other.peak_dram_gb_s);
    for (const auto resource : {&TimedStatistics::issue, &TimedStatistics::l1_port, &TimedStatistics::crossbar,
                                &TimedStatistics::l2_slices, &TimedStatistics::dram, &TimedStatistics::l1_tags,
                                &TimedStatistics::l1_data, &TimedStatistics::l1_mshrs, &TimedStatistics::l2_mshrs}) {
        (this->*resource).busy += (other.*resource).busy;
        (this->*resource).copies = (other.*resource).copies;
    }
    return *this;
}

}  // namespace raycache::cachesim
