// An SM whose warps' traces say what waits for what (traces::WarpTrace::issue): a warp issues step after step and load
// after load, and waits only where a step needs data that are not there. Its accesses are under way beside each other
// (pending_accesses.hpp), its instructions are those of the steps alone. It ends when all its data are there.
#include <algorithm>

#include "cachesim/replay/timed/timed_sm.hpp"

namespace raycache::cachesim {

/// The first warp with steps has come.
void TimedSm::prepare_steps() {
    if (!pending_.empty()) return;
    pending_.resize(warps_.size());
    first_place_ = data_.size();
    data_.resize(first_place_ + warps_.size() * PendingAccesses::most);
    for (Port& port : ports_) port.use(data_.data());
}

/// Before this cycle the warp can not go on; `never`: it is not known.
Cycle TimedSm::obstacle(std::uint32_t slot) const {
    const ResidentWarp& records = warps_[slot].records;
    const PendingAccesses& pending = pending_[slot];
    if (const traces::IssueStep* step = records.step()) return step->needs == 0 ? 0 : pending.ready(step->needs - 1);
    return records.at_end() ? pending.all() : pending.room();
}

void TimedSm::wait_until(std::uint32_t number, Cycle time) {
    if (time == never)
        pending_[slot_of(number)].waits = true;
    else
        events_.push(time, number);
}

/// The flight's next instruction or load may issue in that cycle.
void TimedSm::follow_steps(std::uint32_t number, Cycle time) {
    const std::uint32_t slot = slot_of(number);
    ResidentWarp& records = warps_[slot].records;
    for (;;) {
        shading(number);
        if (const Cycle ready = obstacle(slot); ready > time) {
            if (flow_) flow_->visits[number] = {};
            wait_until(number, ready);
            return;
        }
        const traces::IssueStep* step = records.step();
        if (!step) break;
        records.take_step();
        if (step->instructions == 0) continue;
        if (flow_) {
            flow_->visits[number] = {};
            flow_->visits[number].instructions = step->instructions;
            wake(number, time);
        } else {
            events_.push(run_instructions(number, time, step->instructions, 0), number);
        }
        return;
    }
    if (records.at_end()) {
        end_flight(number, time);
        return;
    }
    open_place(number);
    Flight& flight = flights_[number];
    if (flow_) {
        flow_->visits[number] = {};
        flow_->visits[number].loads = flight.loads;
        wake(number, time);
    } else {
        schedulers_[flight.scheduler].make_ready(flight.bit);
        note(flight.scheduler);
    }
}

/// The flight takes the warp's next access.
void TimedSm::open_place(std::uint32_t number) {
    const std::uint32_t slot = slot_of(number);
    ResidentWarp& records = warps_[slot].records;
    if (free_visits_.empty()) free_visits_.push_back(&visits_.emplace_back());
    VisitAtPort& visit = *free_visits_.back();
    free_visits_.pop_back();
    const std::uint32_t before = records.accesses();
    begin_visit(number, visit);
    const std::uint32_t last = records.accesses() - 1,
                        place = pending_[slot].open(std::min(before, last), last, &visit);
    data_[first_place_ + std::size_t{slot} * PendingAccesses::most + place] = {0, 0, number, false};
}

Port::Load TimedSm::load_of_place(std::uint32_t number, std::uint32_t place, std::uint32_t load) {
    const std::uint32_t slot = slot_of(number);
    return {pending_[slot][place].visit, number, load,
            static_cast<std::uint32_t>(first_place_ + std::size_t{slot} * PendingAccesses::most + place)};
}

void TimedSm::step_load_passed(const Port::Load& load) {
    VisitAtPort& visit = *load.visit;
    if (++visit.passed < visit.shape->loads) return;
    free_visits_.push_back(&visit);
    LoadData& data = data_[load.data];
    data.asked = true;
    if (data.known()) data_known(load.data);
}

/// All sectors of an access have been looked up, and when the last arrives is known.
void TimedSm::step_data_known(std::uint32_t data_number) {
    const LoadData& data = data_[data_number];
    const std::uint32_t slot = slot_of(data.flight);
    PendingAccesses& pending = pending_[slot];
    PendingAccesses::Place& place = pending[(data_number - first_place_) % PendingAccesses::most];
    const Cycle arrival = data.arrival + rules_.timing.l1_latency;
    counts_.visit_cycles += arrival - place.first_issue;
    place.ready = flow_ ? arrival - issue_to_port : arrival;
    if (!pending.waits) return;
    const Cycle time = obstacle(slot);
    if (time == never) return;
    pending.waits = false;
    events_.push(std::max(time, now_), data.flight);
}

}  // namespace raycache::cachesim
