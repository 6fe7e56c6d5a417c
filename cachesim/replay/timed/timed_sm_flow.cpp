// An SM with operand collectors: the loads and instructions of its visits, one by one.
//
// Loads of a visit depend on nothing. Of its instructions number i needs the data of load i, or of the last load if
// there are fewer; from dependent_chains on it needs the result of the one dependent_chains before. The next visit
// begins when all have issued, or, if they are fewer than the loads, when all data are there.
#include <algorithm>
#include <bit>

#include "cachesim/replay/timed/timed_sm.hpp"

namespace raycache::cachesim {

namespace {

constexpr Cycle issue_to_unit = 3;  ///< register, collector, register

unsigned first(std::uint64_t bits) { return static_cast<unsigned>(std::countr_zero(bits)); }

}  // namespace

/// When the next instruction of the flight has its operands; `never`: it is not known yet.
Cycle TimedSm::ready_time(std::uint32_t number) const {
    const InstructionFlow::Visit& visit = flow_->visits[number];
    if (visit.next < visit.loads) return 0;
    const std::uint32_t instruction = visit.next - visit.loads, chains = rules_.timing.dependent_chains;
    const auto data = [&](std::uint32_t load) {
        const LoadData& d = data_[number * data_per_flight_ + load];
        return d.known() ? d.arrival + rules_.timing.l1_latency - issue_to_port : never;
    };
    if (instruction == visit.instructions) {
        Cycle time = 0;
        for (std::uint32_t load = 0; load < visit.loads; ++load) time = std::max(time, data(load));
        return time;
    }
    if (instruction >= chains) return flow_->results[number * chains + instruction % chains];
    return visit.loads == 0 ? 0 : data(std::min(instruction, visit.loads - 1));
}

/// After an issue at that cycle: the flight waits for what its next instruction needs.
void TimedSm::advance(std::uint32_t number, Cycle time) {
    InstructionFlow::Visit& visit = flow_->visits[number];
    if (visit.over() && has_steps(number)) {
        follow_steps(number, time + 1);
        return;
    }
    if (visit.over() && visit.instructions >= visit.loads) {
        open_visit(number, time);
        return;
    }
    const Cycle ready = ready_time(number);
    if (ready == never)
        visit.waits = true;
    else if (ready <= time + 1)
        wake(number, time);
    else
        events_.push(ready, number);
}

/// The next instruction may issue.
void TimedSm::wake(std::uint32_t number, Cycle time) {
    const InstructionFlow::Visit& visit = flow_->visits[number];
    if (visit.over()) {
        if (has_steps(number))
            follow_steps(number, time);
        else
            open_visit(number, time);
        return;
    }
    const Flight& flight = flights_[number];
    flow_->ready[flight.scheduler][visit.next < visit.loads] |= std::uint64_t{1} << flight.bit;
}

void TimedSm::open_visit(std::uint32_t number, Cycle time) {
    InstructionFlow::Visit& visit = flow_->visits[number];
    visit = {};
    visit.instructions = shading(number);
    if (visit.instructions == 0) {
        if (!begin_visit(number, flights_[number].visit)) {
            end_flight(number, time);
            return;
        }
        const Flight& flight = flights_[number];
        visit.loads = visit.unknown = flight.loads;
        visit.instructions = flight.instructions;
        for (std::uint32_t load = 0; load < visit.loads; ++load)
            data_[number * data_per_flight_ + load] = {0, 0, number, false};
    }
    wake(number, time);
}

bool TimedSm::issue_one(unsigned number, Cycle time) {
    InstructionFlow& flow = *flow_;
    WarpScheduler& scheduler = schedulers_[number];
    auto& ready = flow.ready[number];
    std::uint64_t able = 0;
    for (const auto kind : {OperandCollectors::arithmetic, OperandCollectors::load})
        if (flow.collectors.takes(number, kind)) able |= ready[kind];
    if (!able) return false;
    const unsigned bit = scheduler.pick(able);
    const bool load = ready[OperandCollectors::load] >> bit & 1;
    ready[load] &= ~(std::uint64_t{1} << bit);
    const std::uint32_t chosen = scheduler.flight(bit);
    InstructionFlow::Visit& visit = flow.visits[chosen];
    Flight& flight = flights_[chosen];
    counts_.issue.busy += 1;
    if (load) {
        ++counts_.loads;
        flight.first_issue = std::min(flight.first_issue, time);
        std::uint32_t place = 0;
        if (has_steps(chosen)) {
            PendingAccesses& pending = pending_[slot_of(chosen)];
            place = pending.latest();
            pending[place].first_issue = flight.first_issue;
        }
        flow.collectors.issue(number, chosen, visit.next, OperandCollectors::load, place);
    } else {
        const std::uint32_t chains = rules_.timing.dependent_chains, instruction = visit.next - visit.loads;
        ++counts_.instructions;
        flow.results[chosen * chains + instruction % chains] = never;
        flow.collectors.issue(number, chosen, instruction, OperandCollectors::arithmetic);
    }
    ++visit.next;
    advance(chosen, time);
    return true;
}

/// Arithmetic units take what is collected.
bool TimedSm::run_units(Cycle now) {
    InstructionFlow& flow = *flow_;
    const Timing& timing = rules_.timing;
    const std::uint32_t chains = timing.dependent_chains;
    bool moved = false;
    for (std::uint64_t left = flow.collectors.collected(OperandCollectors::arithmetic); left; left &= left - 1) {
        const unsigned s = first(left);
        if (flow.unit_free[s] > now) continue;
        const OperandCollectors::Instruction at = flow.collectors.take(s, OperandCollectors::arithmetic);
        const Cycle done = now + std::max<Cycle>(timing.instruction_latency, issue_to_unit + 1) - issue_to_unit;
        InstructionFlow::Visit& visit = flow.visits[at.flight];
        flow.results[at.flight * chains + at.number % chains] = done;
        if (visit.waits && visit.next == visit.loads + at.number + chains) {
            visit.waits = false;
            events_.push(done, at.flight);
        }
        flow.unit_free[s] = now + timing.instruction_interval;
        moved = true;
    }
    return moved;
}

/// Ports go on with their loads, or take the oldest that is collected, for the next cycle.
bool TimedSm::feed_ports(Cycle now, Cycle end) {
    OperandCollectors& collectors = flow_->collectors;
    bool moved = false;
    for (Port& port : ports_) {
        if (!port.empty() && port.free() <= now) {
            serve(port, now, end);
            moved = true;
        }
        if (!port.empty() || port.free() > now + 1) continue;
        const OperandCollectors::Instruction* oldest = nullptr;
        unsigned from = 0;
        for (std::uint64_t left = collectors.collected(OperandCollectors::load); left; left &= left - 1) {
            const OperandCollectors::Instruction& at = collectors.collected(first(left), OperandCollectors::load);
            if (&port_of(at.flight) != &port || (oldest && oldest->age < at.age)) continue;
            oldest = &at;
            from = first(left);
        }
        if (!oldest) continue;
        const OperandCollectors::Instruction at = collectors.take(from, OperandCollectors::load);
        if (has_steps(at.flight))
            port.push(load_of_place(at.flight, at.place, at.number));
        else
            port.push({&flights_[at.flight].visit, at.flight, at.number, at.flight * data_per_flight_ + at.number});
        port.hold(now + 1);
        moved = true;
    }
    return moved;
}

/// The next cycle in which anything can move, after one in which nothing did.
Cycle TimedSm::next_in_flow(Cycle end) const {
    const OperandCollectors& collectors = flow_->collectors;
    Cycle next = std::min(end, events_.time());
    for (std::uint64_t left = collectors.collected(OperandCollectors::arithmetic); left; left &= left - 1)
        next = std::min(next, flow_->unit_free[first(left)]);
    for (const Port& port : ports_) {
        if (!port.empty())
            next = std::min(next, port.free());
        else if (collectors.collected(OperandCollectors::load))
            next = std::min(next, port.free() - 1);
    }
    if (fetches_ahead()) next = 0;
    return std::max(next, now_ + 1);
}

void TimedSm::run_flow(Cycle end) {
    const auto count = static_cast<unsigned>(schedulers_.size());
    while (now_ < end) {
        while (events_.time() <= now_) {
            const Cycle time = events_.time();
            wake(events_.pop(), time);
        }
        bool moved = run_units(now_);
        moved |= feed_ports(now_, end);
        if (private_) serve_private(now_);
        moved |= flow_->collectors.advance();
        for (unsigned s = 0; s < count; ++s) moved |= issue_one(static_cast<unsigned>((s + now_) % count), now_);
        now_ = moved ? now_ + 1 : next_in_flow(end);
    }
    now_ = std::max(now_, end);
}

}  // namespace raycache::cachesim
