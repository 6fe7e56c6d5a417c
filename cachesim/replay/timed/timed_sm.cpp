#include "cachesim/replay/timed/timed_sm.hpp"

#include <algorithm>
#include <bit>

namespace raycache::cachesim {

namespace {

std::uint32_t instructions_of(const Timing& timing, traces::ObjectKind kind) {
    switch (kind) {
        case traces::ObjectKind::node:
            return timing.node_instructions;
        case traces::ObjectKind::triangle:
            return timing.triangle_instructions;
        default:
            return timing.texel_instructions;
    }
}

}  // namespace

TimedRules::TimedRules(const Gpu& g, const std::vector<traces::Region>& regions, const Idealised& idealised)
    : gpu(g),
      timing(*g.timing),
      ideal(idealised),
      l1_map(g.l1()),
      sectors_per_line(g.l1().line_bytes / g.l1().sector_bytes),
      line_of_sector(std::countr_zero(sectors_per_line)),
      cta_slots(std::max(1u, g.warps_per_sm / g.warps_per_cta)) {
    for (const traces::Region& region : regions) {
        shapes.emplace_back(region, g.front_end, g.l1().sector_bytes);
        instructions.push_back(instructions_of(timing, region.kind));
    }
}

TimedSm::L1::L1(const TimedRules& rules)
    : tags(rules.gpu.l1().slices * rules.gpu.l1().sets, rules.gpu.l1().ways, rules.sectors_per_line,
           rules.gpu.l1().policy == "fifo"),
      fills(make_fill_buffer(rules.gpu.l1(), rules.timing.l1_mshrs)),
      entries(static_cast<std::uint32_t>(rules.gpu.l1().slices * rules.gpu.l1().sets * rules.gpu.l1().ways)),
      merges((entries + (fills ? fills->lines() : 0)) * std::size_t{rules.sectors_per_line}),
      waiters(merges.size(), SectorTags::none) {}

TimedSm::TimedSm(const TimedRules& rules, std::uint16_t number)
    : rules_(rules),
      number_(number),
      warps_(std::size_t{rules.cta_slots} * rules.gpu.warps_per_cta),
      flights_(warps_.size() * rules.timing.accesses_in_flight),
      per_warp_(rules.timing.accesses_in_flight),
      unfinished_(rules.cta_slots),
      schedulers_(rules.timing.schedulers) {
    for (unsigned i = 0; i < rules.gpu.l1_per_sm; ++i) l1s_.emplace_back(rules);
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
        warp.age = placed_++;
        warp.flights = per_warp_;
        ++resident_;
        ++unfinished_[cta_slot];
        for (std::uint32_t f = slot * per_warp_; f < (slot + 1) * per_warp_; ++f) {
            flights_[f].computing = true;  // as if it came from the instructions of a visit
            events_.push({from, f});
        }
    }
}

void TimedSm::begin_visit(std::uint32_t number, Cycle time) {
    Warp& warp = warp_of(number);
    while (warp.next != warp.end && !warp.next->is_access()) ++warp.next;
    if (warp.next == warp.end) {
        end_flight(number, time);
        return;
    }
    const traces::Record& record = *warp.next++;
    std::uint32_t mask = record.mask;
    unsigned lanes = record.lanes();
    if (rules_.ideal.full_warps) {
        for (; warp.next != warp.end; ++warp.next) {
            if (!warp.next->is_access()) continue;
            if (warp.next->region != record.region || lanes + warp.next->lanes() > traces::warp_lanes) break;
            lanes += warp.next->lanes();
        }
        mask = lanes == traces::warp_lanes ? ~0u : (1u << lanes) - 1;
    }
    Flight& flight = flights_[number];
    flight.shape = &rules_.shapes[record.region];
    flight.instructions = rules_.instructions[record.region];
    flight.visit.begin(*flight.shape, mask, warp.elements);
    warp.elements += lanes;
    flight.issued = flight.at_port = flight.unresolved = 0;
    flight.arrival = 0;
    flight.first_issue = ~Cycle{0};
    ++statistics.warp_accesses;
    statistics.lane_accesses += lanes;
    const std::uint32_t bit =
        number / per_warp_ / static_cast<std::uint32_t>(schedulers_.size()) * per_warp_ + number % per_warp_;
    scheduler_of(number).ready |= std::uint64_t{1} << bit;
}

void TimedSm::end_flight(std::uint32_t number, Cycle time) {
    last_end_ = std::max(last_end_, time);
    if (--warp_of(number).flights > 0) return;
    warp_of(number).trace.reset();
    --resident_;
    const unsigned cta = number / per_warp_ / rules_.gpu.warps_per_cta;
    if (--unfinished_[cta] == 0) freed.emplace_back(time, cta);
}

/// The data of a visit are there: its instructions follow. Those that need only earlier data have issued meanwhile.
void TimedSm::compute(std::uint32_t number, Cycle time) {
    Flight& flight = flights_[number];
    flight.computing = true;
    statistics.visit_cycles += time - flight.first_issue;
    statistics.instructions += flight.instructions;
    const Timing& timing = rules_.timing;
    const std::uint32_t interval = timing.instruction_interval;
    const std::uint32_t early = std::min(flight.shape->loads - 1, flight.instructions);
    const std::uint32_t left = flight.instructions - early;
    Scheduler& scheduler = scheduler_of(number);
    scheduler.free = std::max(scheduler.free, time) + Cycle{flight.instructions} * interval;
    statistics.issue.busy += static_cast<double>(flight.instructions) * interval;
    Cycle end = time;
    if (left > 0) {
        const std::uint32_t chains = timing.dependent_chains;
        const std::uint32_t round = std::max(timing.instruction_latency, chains * interval);
        end = time + Cycle{(left - 1) / chains} * round + (left - 1) % chains * interval + 1;
        end = std::max(end, scheduler.free - Cycle{early} * interval);
    }
    events_.push({end, number});
}

unsigned TimedSm::pick(const Scheduler& scheduler, unsigned number) const {
    if (rules_.gpu.scheduler == cachesim::Scheduler::loose_round_robin) {
        const std::uint64_t later =
            scheduler.last == 63 ? 0 : scheduler.ready & (~std::uint64_t{0} << (scheduler.last + 1));
        return static_cast<unsigned>(std::countr_zero(later ? later : scheduler.ready));
    }
    if (scheduler.ready >> scheduler.last & 1) return scheduler.last;
    unsigned oldest = static_cast<unsigned>(std::countr_zero(scheduler.ready));
    for (std::uint64_t left = scheduler.ready; left; left &= left - 1) {
        const auto bit = static_cast<unsigned>(std::countr_zero(left));
        if (warps_[flight_of(number, bit) / per_warp_].age < warps_[flight_of(number, oldest) / per_warp_].age)
            oldest = bit;
    }
    return oldest;
}

void TimedSm::issue(unsigned number, Cycle time) {
    Scheduler& scheduler = schedulers_[number];
    const unsigned bit = pick(scheduler, number);
    const std::uint32_t chosen = flight_of(number, bit);
    Flight& flight = flights_[chosen];
    scheduler.last = bit;
    flight.first_issue = std::min(flight.first_issue, time);
    if (++flight.issued == flight.shape->loads) scheduler.ready &= ~(std::uint64_t{1} << bit);
    ++scheduler.queued;
    scheduler.free = std::max(scheduler.free, time) + 1;
    statistics.issue.busy += 1;
    ++statistics.instructions;
    ++statistics.loads;
    l1s_[chosen / per_warp_ % l1s_.size()].queue.push_back({time, chosen});
}

void TimedSm::visit_done(std::uint32_t number) {
    Flight& flight = flights_[number];
    flight.computing = false;
    events_.push({flight.arrival + rules_.timing.l1_latency, number});
}

void TimedSm::deliver(const MemorySide::Reply& reply) {
    L1& l1 = l1s_[reply.l1];
    const std::size_t place = std::size_t{reply.entry} * rules_.sectors_per_line + reply.sector;
    if (l1.fills)
        l1.fills->set_arrival(reply.entry - l1.entries, reply.sector, reply.ready);
    else
        l1.tags.set_arrival(reply.entry, reply.sector, reply.ready);
    l1.arrivals.push(reply.ready);
    std::uint32_t waiter = l1.waiters[place];
    l1.waiters[place] = SectorTags::none;
    answer_free_ = std::max(answer_free_, reply.ready);
    while (waiter != SectorTags::none) {
        const auto [number, next] = waiting_[waiter];
        waiting_[waiter].next = free_waiter_;
        free_waiter_ = waiter;
        waiter = next;
        Flight& flight = flights_[number];
        flight.arrival = std::max(flight.arrival, answer_free_);
        if (rules_.timing.answers_per_cycle) ++answer_free_;
        if (--flight.unresolved == 0 && flight.at_port == flight.shape->loads) visit_done(number);
    }
}

void TimedSm::run(Cycle end) {
    while (now_ < end) {
        while (!events_.empty() && events_.top().time <= now_) {
            const Event event = events_.top();
            events_.pop();
            if (flights_[event.flight].computing)
                begin_visit(event.flight, event.time);
            else
                compute(event.flight, event.time);
        }
        Cycle next = end;
        for (unsigned s = 0; s < schedulers_.size(); ++s) {
            if (schedulers_[s].ready && schedulers_[s].queued < rules_.timing.load_queue) {
                issue(s, now_);
                if (schedulers_[s].ready && schedulers_[s].queued < rules_.timing.load_queue) next = now_ + 1;
            }
        }
        for (std::size_t i = 0; i < l1s_.size(); ++i) {
            L1& l1 = l1s_[i];
            while (l1.head < l1.queue.size() && l1.port_free <= now_) {
                l1.port_free = serve_port(l1, static_cast<std::uint8_t>(i), now_, end);
                next = now_ + 1;  // a scheduler may have room again
            }
            if (l1.head < l1.queue.size()) next = std::min(next, l1.port_free);
        }
        if (!events_.empty()) next = std::min(next, std::max(events_.top().time, now_ + 1));
        now_ = std::max(now_ + 1, next);
    }
    now_ = end;
}

}  // namespace raycache::cachesim
