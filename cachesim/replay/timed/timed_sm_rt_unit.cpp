// An SM with an RT unit: visits to nodes and triangles between the SM and the unit (rt_unit.hpp).
#include <algorithm>

#include "cachesim/replay/timed/timed_sm.hpp"

namespace raycache::cachesim {

void TimedSm::begin_in_rt_unit(std::uint32_t number, Cycle time) {
    if (rt_unit_->holds(number))
        rt_unit_->make_ready(number);
    else
        rt_unit_->enter(number, time);
}

/// The SM has something else to do for the flight.
void TimedSm::leave_rt_unit(std::uint32_t number, Cycle time) {
    if (rt_unit_ && rt_unit_->holds(number)) rt_unit_->leave(number, time);
}

void TimedSm::issue_of_rt_unit(Cycle time) {
    RtUnit& unit = *rt_unit_;
    for (std::uint32_t i = 0; i < unit.loads_per_cycle() && unit.can_issue(); ++i) {
        const std::uint32_t chosen = unit.next();
        Flight& flight = flights_[chosen];
        flight.first_issue = std::min(flight.first_issue, time);
        const std::uint32_t load = flight.issued++;
        unit.issue_load(flight.issued == flight.loads);
        port_of(chosen).push({&flight.visit, chosen, load, chosen});
    }
}

}  // namespace raycache::cachesim
