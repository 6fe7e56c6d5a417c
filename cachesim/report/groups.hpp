// Splits launches into the groups of a report.
#pragma once

#include <string>
#include <vector>

#include "cachesim/report/report.hpp"

namespace raycache::cachesim {

struct LaunchGroup {
    std::string name;                 ///< "all", "camera", "bounce 1", "shadow 0", "node"
    std::vector<Counters> by_launch;  ///< zeros where a launch lacks the group
    Counters loads, stores;           ///< of all launches: what reads and what writes; sorts are neither
};

/// none: "all". bounce: each ray type and bounce. ray: each ray type. object: each kind that is read; `rays` are then
/// those of the whole launch, so that bytes/ray of the kinds add up to the total. Order: ray type, bounce; kind.
std::vector<LaunchGroup> split(const std::vector<LaunchStatistics>&, GroupBy);

}  // namespace raycache::cachesim
