#include "cachesim/replay/timed/timed_sm.hpp"

#include <algorithm>
#include <bit>

namespace raycache::cachesim {

TimedSm::TimedSm(const TimedRules& rules, LineIds& ids, std::uint16_t number)
    : rules_(rules),
      warps_(std::size_t{rules.cta_slots} * rules.gpu.warps_per_cta),
      flights_(warps_.size() * rules.timing.accesses_in_flight),
      per_warp_(rules.timing.accesses_in_flight),
      data_per_flight_(rules.collectors() ? rules.most_loads() : 1),
      data_(flights_.size() * data_per_flight_),
      unfinished_(rules.cta_slots),
      schedulers_(rules.timing.schedulers, WarpScheduler(rules.gpu)),
      answer_rate_(rules.timing.answers_per_cycle),
      events_(flights_.size()) {
    const auto schedulers = static_cast<std::uint32_t>(schedulers_.size());
    for (std::uint32_t f = 0; f < flights_.size(); ++f) {
        const std::uint32_t warp = f / per_warp_, bit = warp / schedulers * per_warp_ + f % per_warp_;
        flights_[f].scheduler = static_cast<std::uint8_t>(warp % schedulers);
        flights_[f].bit = static_cast<std::uint8_t>(bit);
        schedulers_[warp % schedulers].assign(bit, f);
    }
    if (rules.three_levels()) private_.emplace(rules, number);
    for (std::uint32_t i = 0; i < rules.gpu.l1_per_sm; ++i)
        ports_.emplace_back(rules, ids, number, static_cast<std::uint8_t>(i), data_.data(), private_ ? asked_ : misses);
    for (std::uint32_t i = 0; i < data_.size(); ++i) data_[i].flight = i / data_per_flight_;
    if (rules.collectors()) flow_.emplace(rules.timing, flights_.size());
    if (rules.rt_unit()) rt_unit_.emplace(*rules.gpu.rt_unit, rules.ideal.infinite_bandwidth, flights_.size());
}

void TimedSm::place(unsigned cta_slot, std::span<const WarpPointer> warps, Cycle from) {
    for (std::size_t i = 0; i < warps.size(); ++i) {
        const traces::WarpTrace& trace = *warps[i];
        const auto slot = static_cast<std::uint32_t>(cta_slot * rules_.gpu.warps_per_cta + i);
        for (const traces::Record& record : trace.records)
            if (!record.is_access()) counts_.rays += record.lanes();
        if (trace.elements.empty()) continue;
        Warp& warp = warps_[slot];
        warp.records.begin(warps[i], from);
        warp.flights = per_warp_;
        if (warp.records.has_steps()) {
            warp.flights = 1;
            prepare_steps();
            pending_[slot].clear();
        }
        ++counts_.warps;
        ++resident_;
        ++unfinished_[cta_slot];
        for (std::uint32_t f = slot * per_warp_; f < slot * per_warp_ + warp.flights; ++f) {
            flights_[f].in_rt_unit = false;
            flights_[f].computing = true;  // as if it came from the instructions of a visit
            schedulers_[flights_[f].scheduler].become_resident(flights_[f].bit, placed_);
            if (flow_) flow_->visits[f] = {};
            events_.push(from, f);
        }
        ++placed_;
    }
}

void TimedSm::end_kernel() {
    for (Port& port : ports_) port.end_kernel(private_.has_value());
    for (WarpScheduler& scheduler : schedulers_) scheduler.end_kernel();
    answer_rate_ = AnswerRate(rules_.timing.answers_per_cycle);
    if (rules_.collectors()) flow_.emplace(rules_.timing, flights_.size());
}

TimedStatistics TimedSm::statistics(Cycle now) const {
    TimedStatistics all = counts_;
    for (const Port& port : ports_) {
        const Port::Counts& counts = port.counts();
        all.levels[0] += counts.answers;
        all.l1_port.busy += counts.busy;
        all.l1_tags.busy += counts.tags;
        all.l1_mshrs.busy += counts.registers;
    }
    if (private_) all.levels[1] += private_->counts();
    if (rt_unit_) {
        all.rt_loads = rt_unit_->loads();
        all.rt_box_tests.busy = rt_unit_->boxes.busy();
        all.rt_triangle_tests.busy = rt_unit_->triangles.busy();
        all.rt_warps.busy = static_cast<double>(rt_unit_->place_cycles(now));
    }
    for (const Warp& warp : warps_)
        if (warp.records.resident()) all.warp_cycles += now - std::min(now, warp.records.since());
    return all;
}

/// The flight takes the warp's next access; false if there is none.
bool TimedSm::begin_visit(std::uint32_t number, VisitAtPort& visit) {
    const bool steps = has_steps(number);
    const auto access = warps_[slot_of(number)].records.next(rules_);
    if (!access) return false;
    Flight& flight = flights_[number];
    visit.region = access->region;
    visit.shape = steps ? &rules_.sm_shape(access->region) : &rules_.shapes[access->region];
    visit.visit.begin(*visit.shape, access->mask, access->elements, rules_.gpu.simd_width);
    visit.passed = visit.there = 0;
    flight.loads = visit.shape->loads;
    flight.instructions = rules_.instructions[access->region] + access->leaf_instructions;
    if (rt_unit_) flight.tests = steps ? 0 : access->lanes * rules_.tests[access->region];
    flight.issued = 0;
    flight.first_issue = never;
    ++counts_.warp_accesses;
    counts_.lane_accesses += access->lanes;
    return true;
}

/// The flight's instructions are done.
void TimedSm::make_ready(std::uint32_t number, Cycle time) {
    if (has_steps(number)) {
        follow_steps(number, time);
        return;
    }
    if (const std::uint32_t count = shading(number)) {
        leave_rt_unit(number, time);
        events_.push(run_instructions(number, time, count, 0), number);
        return;
    }
    if (!begin_visit(number, flights_[number].visit)) {
        leave_rt_unit(number, time);
        end_flight(number, time);
        return;
    }
    data_[number] = {0, 0, number, false};
    Flight& flight = flights_[number];
    flight.in_rt_unit = flight.tests > 0;
    if (flight.in_rt_unit) {
        begin_in_rt_unit(number, time);
        return;
    }
    leave_rt_unit(number, time);
    schedulers_[flight.scheduler].make_ready(flight.bit);
    note(flight.scheduler);
}

void TimedSm::end_flight(std::uint32_t number, Cycle time) {
    last_end_ = std::max(last_end_, time);
    const std::uint32_t slot = slot_of(number);
    Warp& warp = warps_[slot];
    if (--warp.flights > 0) return;
    counts_.warp_cycles += time - warp.records.since();
    warp.records.end();
    --resident_;
    const unsigned cta = slot / rules_.gpu.warps_per_cta;
    if (--unfinished_[cta] == 0) freed.emplace_back(time, cta);
}

/// Instructions of a flight that begin at that time, but for the `early` ones that have issued meanwhile; returns when
/// the last of them has.
Cycle TimedSm::run_instructions(std::uint32_t number, Cycle time, std::uint32_t count, std::uint32_t early) {
    counts_.instructions += count;
    counts_.issue.busy += static_cast<double>(count) * rules_.timing.instruction_interval;
    return schedulers_[flights_[number].scheduler].run(time, count, early);
}

/// The data of a visit are there: its instructions follow. Those that need only earlier data have issued meanwhile.
void TimedSm::compute(std::uint32_t number, Cycle time) {
    Flight& flight = flights_[number];
    flight.computing = true;
    counts_.visit_cycles += time - flight.first_issue;
    warps_[slot_of(number)].records.prefetch();
    if (flight.in_rt_unit) {
        const bool triangle = rules_.triangle[flight.visit.region];
        events_.push((triangle ? rt_unit_->triangles : rt_unit_->boxes).run(time, flight.tests), number);
        return;
    }
    const std::uint32_t early = std::min(flight.loads - 1, flight.instructions);
    events_.push(run_instructions(number, time, flight.instructions, early), number);
}

/// Before this cycle nothing happens here unless a reply arrives.
Cycle TimedSm::next_time() const {
    if (flow_ && !flow_->idle()) return now_;
    if (can_issue() || fetches_ahead()) return now_;
    Cycle next = events_.time();
    for (const Port& port : ports_)
        if (!port.empty()) next = std::min(next, port.free());
    return next;
}

void TimedSm::issue(unsigned number, Cycle time) {
    WarpScheduler& scheduler = schedulers_[number];
    const unsigned bit = scheduler.pick_ready();
    const std::uint32_t chosen = scheduler.flight(bit);
    Flight& flight = flights_[chosen];
    flight.first_issue = std::min(flight.first_issue, time);
    const std::uint32_t load = flight.issued++;
    scheduler.issue_load(bit, flight.issued == flight.loads, time);
    note(number);
    ++counts_.loads;
    if (has_steps(chosen)) {
        PendingAccesses& pending = pending_[slot_of(chosen)];
        pending[pending.latest()].first_issue = flight.first_issue;
        port_of(chosen).push(load_of_place(chosen, pending.latest(), load));
        if (flight.issued == flight.loads) events_.push(time + 1, chosen);
        return;
    }
    port_of(chosen).push({&flight.visit, chosen, load, chosen});
}

/// The load at the front of a port goes on, as far as `end`.
void TimedSm::serve(Port& port, Cycle now, Cycle end) {
    const auto load = port.serve(now, end);
    if (!load) return;
    Flight& flight = flights_[load->flight];
    if (flight.in_rt_unit) {
        rt_unit_->load_passed();
    } else if (!flow_) {
        schedulers_[flight.scheduler].load_passed();
        note(flight.scheduler);
    }
    if (has_steps(load->flight)) {
        step_load_passed(*load);
        return;
    }
    LoadData& data = data_[load->data];
    data.asked = ++flight.visit.passed == flight.loads || flow_;
    if (data.known()) data_known(load->data);
}

/// All sectors have been looked up, and when the last arrives is known.
void TimedSm::data_known(std::uint32_t number) {
    const LoadData& data = data_[number];
    if (has_steps(data.flight)) {
        step_data_known(number);
        return;
    }
    if (!flow_) {
        flights_[number].computing = false;
        events_.push(data.arrival + rules_.timing.l1_latency, number);
        return;
    }
    InstructionFlow::Visit& visit = flow_->visits[data.flight];
    visit.latest = std::max(visit.latest, data.arrival);
    if (--visit.unknown == 0)
        counts_.visit_cycles += visit.latest + rules_.timing.l1_latency - flights_[data.flight].first_issue;
    if (!visit.waits) return;
    const Cycle time = ready_time(data.flight);
    if (time == never) return;
    visit.waits = false;
    events_.push(std::max(time, now_), data.flight);
}

void TimedSm::deliver(const MemorySide::Reply& reply) {
    if (!private_) {
        ports_[reply.l1].arrive(reply.number, reply.ready, answer_rate_,
                                [this](std::uint32_t data) { data_known(data); });
        return;
    }
    private_->deliver(reply, answered_);
    tell_ports();
}

/// Where they are told of lies all over the caches of the processor that runs this: it is asked for all at once first.
void TimedSm::take_replies() {
    if (!private_) {
        for (const MemorySide::Reply& reply : replies) ports_[reply.l1].prefetch(reply.number);
        for (const MemorySide::Reply& reply : replies) ports_[reply.l1].prefetch_line(reply.number);
    }
    for (const MemorySide::Reply& reply : replies) deliver(reply);
    replies.clear();
}

/// What the core's L2 answered.
void TimedSm::tell_ports() {
    for (const PrivateLevel::Answer& answer : answered_)
        ports_[answer.l1].arrive(answer.number, answer.arrival, answer_rate_,
                                 [this](std::uint32_t data) { data_known(data); });
    answered_.clear();
}

void TimedSm::serve_private(Cycle now) {
    for (const MissRequest& request : asked_) private_->ask(request);
    asked_.clear();
    if (private_->idle()) return;
    private_->serve(now, misses, answered_);
    tell_ports();
}

void TimedSm::run(Cycle end) {
    take_replies();
    if (flow_) {
        run_flow(end);
        return;
    }
    while (now_ < end) {
        while (events_.time() <= now_) {
            const Cycle time = events_.time();
            const std::uint32_t flight = events_.pop();
            if (flights_[flight].computing)
                make_ready(flight, time);
            else
                compute(flight, time);
        }
        for (std::uint64_t left = can_issue_; left; left &= left - 1)
            issue(static_cast<unsigned>(std::countr_zero(left)), now_);
        if (rt_unit_) issue_of_rt_unit(now_);
        Cycle next = std::min(end, events_.time());
        for (Port& port : ports_) {
            while (!port.empty() && port.free() <= now_) serve(port, now_, end);
            if (!port.empty()) next = std::min(next, port.free());
        }
        if (private_) {
            serve_private(now_);
            if (!private_->idle()) next = now_ + 1;
        }
        // What the ports took in leaves room for more.
        now_ = can_issue() ? now_ + 1 : std::max(now_ + 1, std::min(next, events_.time()));
    }
    now_ = end;
}

}  // namespace raycache::cachesim
