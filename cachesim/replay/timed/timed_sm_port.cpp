// The L1s of an SM: the port that loads go through, look-ups, misses.
#include <algorithm>
#include <bit>
#include <cmath>

#include "cachesim/replay/timed/timed_sm.hpp"

namespace raycache::cachesim {

void TimedSm::wait(std::uint32_t& list, std::uint32_t who, std::uint8_t l1) {
    std::uint32_t waiter = free_waiter_;
    if (waiter == none) {
        waiter = static_cast<std::uint32_t>(waiters_.size());
        waiters_.emplace_back();
    } else {
        free_waiter_ = waiters_[waiter].next;
    }
    waiters_[waiter] = {who, list, l1};
    list = waiter;
}

/// The arrival of a sector that was sent for is known.
void TimedSm::arrive_in_l1(std::uint8_t number, std::uint32_t register_number, Cycle time) {
    TimedCache& cache = l1s_[number].cache;
    cache.set_arrival(register_number, time);
    answer_free_ = std::max(answer_free_, time);
    std::uint32_t waiter = cache.registers()[register_number].waiters;
    while (waiter != none) {
        const Waiter w = waiters_[waiter];
        waiters_[waiter].next = free_waiter_;
        free_waiter_ = waiter;
        waiter = w.next;
        Flight& flight = flights_[w.who];
        flight.arrival = std::max(flight.arrival, answer_free_);
        if (rules_.timing.answers_per_cycle) ++answer_free_;
        if (--flight.unresolved == 0 && flight.at_port == flight.shape->loads) visit_done(w.who);
    }
    cache.registers()[register_number].waiters = none;
}

void TimedSm::deliver(const MemorySide::Reply& reply) {
    if (!private_) {
        arrive_in_l1(reply.l1, reply.number, reply.ready);
        return;
    }
    TimedCache& cache = private_->cache;
    cache.set_arrival(reply.number, reply.ready);
    std::uint32_t waiter = cache.registers()[reply.number].waiters;
    while (waiter != none) {
        const Waiter w = waiters_[waiter];
        waiters_[waiter].next = free_waiter_;
        free_waiter_ = waiter;
        waiter = w.next;
        arrive_in_l1(w.l1, w.who, reply.ready);
    }
    cache.registers()[reply.number].waiters = none;
}

/// What L1s ask of the core's L2, in order; the first that finds no room holds up the others.
void TimedSm::serve_private(Cycle now) {
    PrivateLevel& level = *private_;
    const Timing& timing = rules_.timing;
    const double cost =
        rules_.ideal.infinite_bandwidth ? 0 : rules_.gpu.l1().sector_bytes / timing.l2_bytes_per_cycle;
    const Cycle latency = rules_.ideal.no_added_latency ? 0 : timing.l2_latency - timing.l1_latency;
    LevelAnswers& answers = statistics.l2;
    while (!level.queue.empty() && level.free <= static_cast<double>(now)) {
        const PrivateLevel::Request request = level.queue.front();
        level.cache.drain(now);
        SectorCache& lines = level.cache.lines();
        MissRegisters& registers = level.cache.registers();
        std::uint32_t entry = lines.find(request.id);
        if (entry != none && (lines[entry].present >> request.sector & 1)) {
            lines.use(entry);
            ++answers.hits;
            arrive_in_l1(request.l1, request.number, now + latency);
        } else if (const auto pending = level.cache.find_pending(request.id, request.sector, entry); pending != none) {
            if (registers[pending].merged >= timing.l2_mshr_merges) return;
            if (entry != none) lines.use(entry);
            ++registers[pending].merged;
            ++answers.merges;
            if (registers[pending].arrival != never)
                arrive_in_l1(request.l1, request.number, registers[pending].arrival);
            else
                wait(registers[pending].waiters, request.number, request.l1);
        } else {
            if (registers.full()) return;
            const bool line_there = entry != none;
            const std::uint32_t number =
                level.cache.send_for(request.id, request.sector, rules_.maps[1](request.line), entry);
            if (number == none) return;
            if (line_there) lines.use(entry);
            ++(line_there ? answers.sector_misses : answers.line_misses);
            wait(registers[number].waiters, request.number, request.l1);
            misses.push_back({now, request.line, request.id, number, number_, request.sector, 0});
        }
        level.free = std::max(level.free, static_cast<double>(now)) + cost;
        level.queue.pop();
    }
}

/// What the L1 does not have: false if it has no room for another miss. `entry`: of the line, or none.
bool TimedSm::miss(L1& l1, std::uint8_t number, std::uint32_t flight_number, std::uint32_t sector, std::uint32_t id,
                   std::uint32_t& entry, Cycle time) {
    Flight& flight = flights_[flight_number];
    LevelAnswers& answers = statistics.l1;
    SectorCache& lines = l1.cache.lines();
    MissRegisters& registers = l1.cache.registers();
    if (const std::uint32_t pending = l1.cache.find_pending(id, sector, entry); pending != none) {
        MissRegisters::Register& r = registers[pending];
        if (r.merged >= rules_.timing.l1_mshr_merges) return false;
        if (entry != none) lines.use(entry);
        ++r.merged;
        ++answers.merges;
        if (r.arrival != never) {
            flight.arrival = std::max(flight.arrival, r.arrival);
        } else {
            wait(r.waiters, flight_number, number);
            ++flight.unresolved;
        }
        return true;
    }
    if (registers.full()) return false;
    const std::uint64_t line = ids_.line(id, flight.region);
    const bool line_there = entry != none;
    const std::uint32_t sent = l1.cache.send_for(id, sector, line_there ? 0 : rules_.maps[0](line), entry);
    if (sent == none) return false;
    if (line_there) lines.use(entry);
    ++(line_there ? answers.sector_misses : answers.line_misses);
    wait(registers[sent].waiters, flight_number, number);
    ++flight.unresolved;
    if (private_)
        private_->queue.push({time, line, id, sent, static_cast<std::uint8_t>(sector), number});
    else
        misses.push_back({time, line, id, sent, number_, static_cast<std::uint8_t>(sector), number});
    return true;
}

/// Looks up one sector of a line; false if the L1 has no room for another miss. `known`: where the line was last.
bool TimedSm::look_up(L1& l1, std::uint8_t number, std::uint32_t flight, std::uint32_t id, std::uint32_t sector,
                      std::uint32_t& known, Cycle time) {
    SectorCache& lines = l1.cache.lines();
    l1.cache.drain(time);
    std::uint32_t entry = lines[known].id == id ? known : lines.find(id);
    bool done = true;
    if (entry != none && (lines[entry].present >> sector & 1)) {
        lines.use(entry);
        ++statistics.l1.hits;
    } else {
        done = miss(l1, number, flight, sector, id, entry, time);
    }
    if (entry != none) known = entry;
    return done;
}

/// When to try again after a look-up that found no room.
Cycle TimedSm::retry_time(L1& l1, Cycle now, Cycle end) const {
    return std::min(end, std::max(now + 1, l1.cache.next_arrival()));
}

/// Serves the load at the front of the queue from this cycle on; returns when the port is free again.
Cycle TimedSm::serve_port(std::uint8_t number, Cycle time, Cycle end) {
    L1& l1 = l1s_[number];
    const Flight& flight = flights_[l1.queue.front()];
    if (!flight.shape->apart) return serve_any(number, time, end);
    return rules_.timing.l1_port == L1Port::banks ? serve_apart<L1Port::banks>(number, time, end)
                                                  : serve_apart<L1Port::tags>(number, time, end);
}

/// The load has passed the port: `end` is when the next can begin.
Cycle TimedSm::end_load(L1& l1, Cycle begin, Cycle end) {
    const std::uint32_t number = l1.queue.front();
    Flight& flight = flights_[number];
    l1.position = 0;
    l1.queue.pop();
    statistics.l1_port.busy += static_cast<double>(end - begin);
    --schedulers_[flight.scheduler].queued;
    note(flight.scheduler);
    if (++flight.at_port == flight.shape->loads && flight.unresolved == 0) visit_done(number);
    return end;
}

/// A later load of a visit whose first load found some of what it asks for: there it is still, if no line that was used
/// since has been evicted. LoadShape::steady.
Cycle TimedSm::serve_later(std::uint8_t number, Cycle begin, Cycle end) {
    L1& l1 = l1s_[number];
    const std::uint32_t flight_number = l1.queue.front();
    Flight& flight = flights_[flight_number];
    const LoadShape& shape = *flight.shape;
    SectorCache& lines = l1.cache.lines();
    SectorCache::Line* const line = lines.lines();
    const std::uint32_t count = flight.visit.count(), k = flight.at_port;
    const Cycle step = rules_.ideal.infinite_bandwidth ? 0 : 1;
    const std::uint32_t first_use = lines.take_time(traces::warp_lanes) + 1;  // of element i: first_use + i
    const std::uint32_t in_visit = ~std::uint32_t{0} >> (traces::warp_lanes - count);
    std::uint32_t next = 0;
    const auto use_up_to = [&](std::uint32_t i) {
        for (; next < i; ++next) line[flight.entries[next]].used = first_use + next;
    };
    for (std::uint32_t left = in_visit & ~flight.there; left; left &= left - 1) {
        const auto i = static_cast<std::uint32_t>(std::countr_zero(left));
        const Cycle time = begin + flight.cycle[i] * step;
        use_up_to(i);
        lines.give_time(first_use + i - 1);
        bool done = false;
        if (time < end) {
            const std::uint32_t sector = (flight.visit[i] + k) >> shape.sector_of_piece;
            const std::uint32_t id = shape.first_id + (sector >> rules_.line_of_sector);
            done = look_up(l1, number, flight_number, id, sector & (rules_.sectors_per_line - 1), flight.entries[i],
                           time);
        }
        if (!done) {
            l1.position = i;
            statistics.l1.hits += std::popcount(flight.there & ((std::uint32_t{1} << i) - 1));
            flight.arrival = std::max(flight.arrival, std::min(time, end - 1));
            return time < end ? retry_time(l1, time, end) : end;
        }
        next = i + 1;
    }
    use_up_to(count);
    lines.give_time(first_use + count - 1);
    statistics.l1.hits += std::popcount(flight.there);
    const Cycle last = begin + flight.cycle[count - 1] * step;
    flight.arrival = std::max(flight.arrival, last);
    return end_load(l1, begin, last + step);
}

/// LoadShape::apart.
template <L1Port port>
Cycle TimedSm::serve_apart(std::uint8_t number, Cycle time, Cycle end) {
    L1& l1 = l1s_[number];
    const std::uint32_t flight_number = l1.queue.front();
    Flight& flight = flights_[flight_number];
    const LoadShape& shape = *flight.shape;
    const std::uint32_t k = flight.at_port;
    if (k > 0 && flight.there && l1.position == 0 && time + flight.cycle[flight.visit.count() - 1] < end && l1.cache.lines().newest_evicted() <= flight.found_since)
        return serve_later(number, time, end);

    TimedCache& cache = l1.cache;
    SectorCache& lines = cache.lines();
    SectorCache::Line* const line = lines.lines();
    const std::uint32_t* const pieces = flight.visit.data();
    const unsigned count = flight.visit.count();
    const int sector_of_piece = shape.sector_of_piece, line_of_sector = rules_.line_of_sector;
    const std::uint32_t first_id = shape.first_id, in_line_mask = rules_.sectors_per_line - 1;
    const std::uint32_t bank_mask = rules_.timing.l1_banks - 1;
    const std::uint32_t most_sectors = rules_.port_sectors, most_tags = rules_.timing.tags_per_cycle;
    const bool lru = lines.is_lru(), perfect = rules_.ideal.perfect_l1;
    const Cycle step = rules_.ideal.infinite_bandwidth ? 0 : 1;
    const Cycle begin = time;
    const unsigned lines_per_element = shape.steady ? 1 : 2;
    // Of the sectors that an element reads, counted from that of the first load.
    const std::uint32_t needed = (std::uint32_t{2} << ((shape.loads - 1) >> sector_of_piece)) - 1;

    unsigned i = l1.position;
    std::uint32_t bits = 0, tags = 0, sectors = 0;  // of this cycle: banks taken; lines; sectors
    std::uint32_t id_before = i > 0 ? first_id + ((pieces[i - 1] + k) >> sector_of_piece >> line_of_sector) : none;
    std::uint64_t hits = 0;
    std::uint32_t used = lines.take_time(traces::warp_lanes);
    const bool first = k == 0 && i == 0;
    if (first) flight.found_since = used;
    std::uint32_t there = 0;
    bool done = true;
    cache.drain(time);
    for (; i < count; ++i) {
        const std::uint32_t sector = (pieces[i] + k) >> sector_of_piece;
        const std::uint32_t id = first_id + (sector >> line_of_sector), in_line = sector & in_line_mask;
        if constexpr (port == L1Port::banks) {
            const std::uint32_t bank = 1u << (sector & bank_mask);
            if (bits & bank) {
                bits = 0;
                time += step;
                if (time >= end) break;
                cache.drain(time);
            }
            bits |= bank;
        } else {
            const bool new_line = id != id_before;
            if (sectors == most_sectors || (new_line && tags == most_tags)) {
                sectors = tags = 0;
                time += step;
                if (time >= end) break;
                cache.drain(time);
            }
            ++sectors;
            tags += new_line;
            id_before = id;
        }
        flight.cycle[i] = static_cast<std::uint8_t>(time - begin);
        if (perfect) {
            ++hits;
            continue;
        }
        std::uint32_t& known = flight.entries[lines_per_element == 1 ? i : 2 * i + (id & 1)];
        std::uint32_t entry = known;
        if (line[entry].id != id) entry = lines.find(id);
        if (entry != none && (line[entry].present >> in_line & 1)) [[likely]] {
            known = entry;
            if (lru)
                line[entry].used = ++used;
            else
                lines.use(entry);
            ++hits;
            there |= std::uint32_t{(line[entry].present >> in_line & needed) == needed} << i;
        } else {
            if (lru) lines.give_time(used);
            done = miss(l1, number, flight_number, in_line, id, entry, time);
            if (lru) used = lines.take_time(traces::warp_lanes);
            if (entry != none) known = entry;
            if (!done) break;
        }
    }
    if (lru) lines.give_time(used);
    statistics.l1.hits += hits;
    if (i < count) {  // the rest when there is room, or in the next window
        l1.position = i;
        flight.there = 0;
        flight.arrival = std::max(flight.arrival, std::min(time, end - 1));
        return time >= end ? end : retry_time(l1, time, end);
    }
    flight.arrival = std::max(flight.arrival, time);
    if (k == 0) flight.there = first && shape.steady && lru && !perfect ? there : 0;
    return end_load(l1, begin, time + step);
}

Cycle TimedSm::serve_any(std::uint8_t number, Cycle time, Cycle end) {
    L1& l1 = l1s_[number];
    const std::uint32_t flight_number = l1.queue.front();
    Flight& flight = flights_[flight_number];
    const LoadShape& shape = *flight.shape;
    const Timing& timing = rules_.timing;
    const bool banks = timing.l1_port == L1Port::banks;
    const Cycle step = rules_.ideal.infinite_bandwidth ? 0 : 1;
    const std::uint32_t k = flight.at_port;
    const Cycle begin = time;
    std::uint32_t used = 0, tags = 0;  // of this cycle: banks taken or sectors; lines
    std::uint64_t before = never;      // the sector looked up last, in this request
    if (l1.position > 0) {
        const std::uint32_t last = l1.position - 1;
        const std::uint32_t element = flight.visit[last / 2];
        if (!(last % 2 == 1 && flight.visit.ends_group(last / 2)))
            before = last % 2 == 0 ? shape.last_sector(element, k) : shape.first_sector(element, k);
    }
    for (; l1.position < 2 * flight.visit.count(); ++l1.position) {
        const std::uint32_t element = flight.visit[l1.position / 2];
        const bool first = l1.position % 2 == 1;
        const std::uint64_t sector = first ? shape.first_sector(element, k) : shape.last_sector(element, k);
        if (sector != before) {
            const std::uint64_t line = sector >> rules_.line_of_sector;
            const bool new_line = before == never || line != before >> rules_.line_of_sector;
            const std::uint32_t bank = 1u << (sector & (timing.l1_banks - 1));
            const bool full = banks ? (used & bank) != 0
                                    : used == rules_.port_sectors || (new_line && tags == timing.tags_per_cycle);
            if (full) {
                time += step;
                used = tags = 0;
            }
            if (time >= end) return end;
            flight.arrival = std::max(flight.arrival, time);
            if (rules_.ideal.perfect_l1)
                ++statistics.l1.hits;
            else if (!look_up(l1, number, flight_number, ids_.id(line, flight.region),
                              static_cast<std::uint32_t>(sector & (rules_.sectors_per_line - 1)),
                              flight.entries[l1.position / 2 * 2 + (line & 1)], time))
                return retry_time(l1, time, end);
            used = banks ? used | bank : used + 1;
            tags += new_line;
            before = sector;
        }
        if (first && flight.visit.ends_group(l1.position / 2)) {
            before = never;
            if (l1.position + 1 < 2 * flight.visit.count()) {  // the next request has a cycle of its own
                time += step;
                used = tags = 0;
            }
        }
    }
    return end_load(l1, begin, time + step);
}

}  // namespace raycache::cachesim
