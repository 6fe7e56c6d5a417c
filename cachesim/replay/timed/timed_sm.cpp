#include "cachesim/replay/timed/timed_sm.hpp"

#include <algorithm>
#include <bit>

#include "cachesim/replay/vectors.hpp"

namespace raycache::cachesim {

TimedSm::TimedSm(const TimedRules& rules, LineIds& ids, std::uint16_t number)
    : rules_(rules),
      ids_(ids),
      number_(number),
      warps_(std::size_t{rules.cta_slots} * rules.gpu.warps_per_cta),
      flights_(warps_.size() * rules.timing.accesses_in_flight),
      per_warp_(rules.timing.accesses_in_flight),
      data_per_flight_(rules.collectors() ? rules.most_loads() : 1),
      data_(flights_.size() * data_per_flight_),
      unfinished_(rules.cta_slots),
      schedulers_(rules.timing.schedulers),
      events_(flights_.size()) {
    const auto schedulers = static_cast<std::uint32_t>(schedulers_.size());
    for (std::uint32_t f = 0; f < flights_.size(); ++f) {
        const std::uint32_t warp = f / per_warp_, bit = warp / schedulers * per_warp_ + f % per_warp_;
        flights_[f].scheduler = static_cast<std::uint8_t>(warp % schedulers);
        flights_[f].bit = static_cast<std::uint8_t>(bit);
        schedulers_[warp % schedulers].flight_of[bit] = static_cast<std::uint16_t>(f);
    }
    for (unsigned i = 0; i < rules.gpu.l1_per_sm; ++i)
        l1s_.push_back({TimedCache(rules.gpu.l1(), number * rules.gpu.l1_per_sm + i, rules.timing.l1_mshrs)});
    if (rules.three_levels())
        private_.emplace(PrivateLevel{TimedCache(rules.gpu.levels[1], number, rules.timing.l2_mshrs)});
    for (std::uint32_t i = 0; i < data_.size(); ++i) data_[i].flight = i / data_per_flight_;
    if (rules.collectors()) flow_.emplace(rules.timing, flights_.size());
}

void TimedSm::place(unsigned cta_slot, std::span<const WarpPointer> warps, Cycle from) {
    for (std::size_t i = 0; i < warps.size(); ++i) {
        const traces::WarpTrace& trace = *warps[i];
        const auto slot = static_cast<std::uint32_t>(cta_slot * rules_.gpu.warps_per_cta + i);
        for (const traces::Record& record : trace.records)
            if (!record.is_access()) statistics.rays += record.lanes();
        if (trace.elements.empty()) continue;
        Warp& warp = warps_[slot];
        warp.trace = warps[i];
        warp.next = trace.records.data();
        warp.end = warp.next + trace.records.size();
        warp.elements = trace.elements.data();
        warp.left = 0;
        warp.among_triangles = false;
        warp.age = placed_++;
        warp.since = from;
        ++statistics.warps;
        warp.flights = per_warp_;
        ++resident_;
        ++unfinished_[cta_slot];
        for (std::uint32_t f = slot * per_warp_; f < (slot + 1) * per_warp_; ++f) {
            flights_[f].computing = true;  // as if it came from the instructions of a visit
            if (flow_) flow_->visits[f] = {};
            events_.push(from, f);
        }
    }
}

/// Instructions before the warp's next access, for the rays that begin there.
std::uint32_t TimedSm::shading(Warp& warp) const {
    std::uint32_t starts = 0;
    for (; warp.next != warp.end && !warp.next->is_access(); ++warp.next) ++starts;
    if (starts > 0) warp.among_triangles = false;
    return starts * rules_.timing.shading_instructions;
}

/// Instructions that its next access, by so many lanes, takes for a leaf that begins there.
std::uint32_t TimedSm::leaf(Warp& warp, std::uint32_t region, unsigned lanes) const {
    const LeafStarts& leaves = *rules_.leaves;
    const bool triangles = leaves.is_triangle(region);
    const bool begins = triangles && leaves.begins(region, {warp.elements, lanes}, warp.among_triangles);
    // Texels, no steps, are read between the triangles of a leaf; vectors of one record begin together.
    if (warp.left == 0 && leaves.is_step(region)) warp.among_triangles = triangles;
    return begins ? rules_.timing.leaf_instructions : 0;
}

/// The flight takes the warp's next access, which stands before no ray that begins; false if there is none.
bool TimedSm::begin_visit(std::uint32_t number) {
    Warp& warp = warp_of(number);
    if (warp.next == warp.end) return false;
    const traces::Record& record = *warp.next;
    if (warp.left == 0) warp.left = record.mask;
    std::uint32_t mask = first_vector(warp.left, rules_.gpu.simd_width);
    warp.left &= ~mask;
    unsigned lanes = static_cast<unsigned>(std::popcount(mask));
    if (warp.left == 0) ++warp.next;
    if (rules_.ideal.full_warps) {
        for (; warp.left == 0 && warp.next != warp.end; ++warp.next) {
            if (!warp.next->is_access()) continue;
            if (warp.next->region != record.region || lanes + warp.next->lanes() > rules_.gpu.simd_width) break;
            lanes += warp.next->lanes();
        }
        mask = lanes == traces::warp_lanes ? ~0u : (1u << lanes) - 1;
    }
    Flight& flight = flights_[number];
    flight.region = record.region;
    flight.shape = &rules_.shapes[record.region];
    flight.instructions = rules_.instructions[record.region];
    if (rules_.leaves) flight.instructions += leaf(warp, record.region, lanes);
    flight.visit.begin(*flight.shape, mask, warp.elements, rules_.gpu.simd_width);
    warp.elements += lanes;
    flight.issued = flight.at_port = flight.there = 0;
    flight.first_issue = never;
    ++statistics.warp_accesses;
    statistics.lane_accesses += lanes;
    return true;
}

/// The flight's instructions are done.
void TimedSm::make_ready(std::uint32_t number, Cycle time) {
    if (const std::uint32_t count = shading(warp_of(number))) {
        events_.push(run_instructions(number, time, count, 0), number);
        return;
    }
    if (!begin_visit(number)) {
        end_flight(number, time);
        return;
    }
    Data& data = data_[number];
    data.arrival = 0;
    data.unresolved = 0;
    data.asked = false;
    const Flight& flight = flights_[number];
    schedulers_[flight.scheduler].ready |= std::uint64_t{1} << flight.bit;
    note(flight.scheduler);
}

void TimedSm::end_flight(std::uint32_t number, Cycle time) {
    last_end_ = std::max(last_end_, time);
    Warp& warp = warp_of(number);
    if (--warp.flights > 0) return;
    statistics.warp_cycles += time - warp.since;
    warp.trace.reset();
    --resident_;
    const unsigned cta = number / per_warp_ / rules_.gpu.warps_per_cta;
    if (--unfinished_[cta] == 0) freed.emplace_back(time, cta);
}

/// Instructions of a flight that begin at that time, but for the `early` ones that have issued meanwhile; returns when
/// the last of them has.
Cycle TimedSm::run_instructions(std::uint32_t number, Cycle time, std::uint32_t count, std::uint32_t early) {
    const Timing& timing = rules_.timing;
    const std::uint32_t interval = timing.instruction_interval, left = count - early;
    Scheduler& scheduler = schedulers_[flights_[number].scheduler];
    statistics.instructions += count;
    statistics.issue.busy += static_cast<double>(count) * interval;
    scheduler.free = std::max(scheduler.free, time) + Cycle{count} * interval;
    if (left == 0) return time;
    const std::uint32_t chains = timing.dependent_chains;
    const std::uint32_t round = std::max(timing.instruction_latency, chains * interval);
    const Cycle end = time + Cycle{(left - 1) / chains} * round + (left - 1) % chains * interval + 1;
    return std::max(end, scheduler.free - Cycle{early} * interval);
}

/// The data of a visit are there: its instructions follow. Those that need only earlier data have issued meanwhile.
void TimedSm::compute(std::uint32_t number, Cycle time) {
    Flight& flight = flights_[number];
    flight.computing = true;
    statistics.visit_cycles += time - flight.first_issue;
    const std::uint32_t early = std::min(flight.shape->loads - 1, flight.instructions);
    events_.push(run_instructions(number, time, flight.instructions, early), number);
}

/// Before this cycle nothing happens here unless a reply arrives.
Cycle TimedSm::next_time() const {
    if (flow_ && !flow_->idle()) return now_;
    if (can_issue_ || (private_ && !private_->queue.empty())) return now_;
    Cycle next = events_.time();
    for (const L1& l1 : l1s_)
        if (!l1.queue.empty()) next = std::min(next, l1.port_free);
    return next;
}

/// Of those that are ready (bits), the one whose turn it is.
unsigned TimedSm::pick(const Scheduler& scheduler, std::uint64_t ready) const {
    if (rules_.gpu.scheduler == cachesim::Scheduler::loose_round_robin) {
        const std::uint64_t later = scheduler.last == 63 ? 0 : ready & (~std::uint64_t{0} << (scheduler.last + 1));
        return static_cast<unsigned>(std::countr_zero(later ? later : ready));
    }
    if (ready >> scheduler.last & 1) return scheduler.last;
    const auto age = [&](unsigned bit) { return warps_[scheduler.flight_of[bit] / per_warp_].age; };
    unsigned oldest = static_cast<unsigned>(std::countr_zero(ready));
    for (std::uint64_t left = ready; left; left &= left - 1) {
        const auto bit = static_cast<unsigned>(std::countr_zero(left));
        if (age(bit) < age(oldest)) oldest = bit;
    }
    return oldest;
}

void TimedSm::issue(unsigned number, Cycle time) {
    Scheduler& scheduler = schedulers_[number];
    const unsigned bit = pick(scheduler, scheduler.ready);
    const std::uint32_t chosen = scheduler.flight_of[bit];
    Flight& flight = flights_[chosen];
    scheduler.last = bit;
    flight.first_issue = std::min(flight.first_issue, time);
    const std::uint32_t load = flight.issued++;
    if (flight.issued == flight.shape->loads) scheduler.ready &= ~(std::uint64_t{1} << bit);
    ++scheduler.queued;
    note(number);
    scheduler.free = std::max(scheduler.free, time) + 1;
    ++statistics.loads;
    l1s_[l1s_.size() == 1 ? 0 : chosen / per_warp_ % l1s_.size()].queue.push({chosen, load, chosen});
}

/// All sectors have been looked up, and when the last arrives is known.
void TimedSm::data_known(std::uint32_t number) {
    const Data& data = data_[number];
    if (!flow_) {
        flights_[number].computing = false;
        events_.push(data.arrival + rules_.timing.l1_latency, number);
        return;
    }
    InstructionFlow::Visit& visit = flow_->visits[data.flight];
    visit.latest = std::max(visit.latest, data.arrival);
    if (--visit.unknown == 0)
        statistics.visit_cycles += visit.latest + rules_.timing.l1_latency - flights_[data.flight].first_issue;
    if (!visit.waits) return;
    const Cycle time = ready_time(data.flight);
    if (time == never) return;
    visit.waits = false;
    events_.push(std::max(time, now_), data.flight);
}

void TimedSm::run(Cycle end) {
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
        Cycle next = std::min(end, events_.time());
        for (L1& l1 : l1s_) {
            while (!l1.queue.empty() && l1.port_free <= now_)
                l1.port_free = serve_port(static_cast<std::uint8_t>(&l1 - l1s_.data()), now_, end);
            if (!l1.queue.empty()) next = std::min(next, l1.port_free);
        }
        if (private_ && !private_->queue.empty()) {
            serve_private(now_);
            if (!private_->queue.empty()) next = now_ + 1;
        }
        // What the ports took in leaves room for more.
        now_ = can_issue_ ? now_ + 1 : std::max(now_ + 1, std::min(next, events_.time()));
    }
    now_ = end;
}

}  // namespace raycache::cachesim
