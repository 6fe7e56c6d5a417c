// The L1s of an SM: look-ups, misses, and the port that loads go through.
#include <algorithm>

#include "cachesim/replay/timed/timed_sm.hpp"

namespace raycache::cachesim {

/// Looks up one sector; false if the L1 has no room for another miss. `entry` is where its line was last, or 0.
bool TimedSm::look_up(L1& l1, std::uint8_t number, std::uint32_t flight_number, std::uint64_t sector_number,
                      std::uint32_t& entry, Cycle time) {
    Flight& flight = flights_[flight_number];
    LevelAnswers& answers = statistics.l1;
    flight.arrival = std::max(flight.arrival, time);
    if (rules_.ideal.perfect_l1) {
        ++answers.hits;
        return true;
    }
    const std::uint64_t line = sector_number >> rules_.line_of_sector;
    const auto sector = static_cast<std::uint32_t>(sector_number & (rules_.sectors_per_line - 1));
    if (!l1.tags.holds(entry, line)) entry = l1.tags.find(line);
    const bool line_there = entry != SectorTags::none;
    std::size_t place = std::size_t{entry} * rules_.sectors_per_line + sector;
    const auto wait_here = [&] {
        std::uint32_t waiter = free_waiter_;
        if (waiter == SectorTags::none) {
            waiter = static_cast<std::uint32_t>(waiting_.size());
            waiting_.emplace_back();
        } else {
            free_waiter_ = waiting_[waiter].next;
        }
        waiting_[waiter] = {flight_number, l1.waiters[place]};
        l1.waiters[place] = waiter;
        ++flight.unresolved;
    };
    if (line_there && l1.tags.present(entry, sector)) {
        if (l1.tags.arrived(entry, sector, time)) {
            l1.tags.use(entry);
            ++answers.hits;
            return true;
        }
        const Cycle arrival = l1.tags.arrival(entry, sector);
        if (l1.merges[place] >= rules_.timing.l1_mshr_merges) return false;
        l1.tags.use(entry);
        ++l1.merges[place];
        ++answers.merges;
        if (arrival == SectorTags::unknown)
            wait_here();
        else
            flight.arrival = std::max(flight.arrival, arrival);
        return true;
    }
    for (; !l1.arrivals.empty() && l1.arrivals.front() <= time; l1.arrivals.pop()) --l1.under_way;
    if (l1.under_way >= rules_.timing.l1_mshrs) {
        if (!line_there) entry = 0;
        return false;
    }
    if (!line_there) {
        entry = l1.tags.replace(rules_.l1_map(line), line, time);
        if (entry == SectorTags::none) {
            entry = 0;
            return false;
        }
        place = std::size_t{entry} * rules_.sectors_per_line + sector;
        ++answers.line_misses;
    } else {
        l1.tags.use(entry);
        ++answers.sector_misses;
    }
    l1.tags.add(entry, sector, SectorTags::unknown);
    l1.merges[place] = 1;
    ++l1.under_way;
    wait_here();
    misses.push_back({time, line, entry, number_, static_cast<std::uint8_t>(sector), number});
    return true;
}

/// Serves the load at the head of the queue from this cycle on; returns when the port is free again.
Cycle TimedSm::serve_port(L1& l1, std::uint8_t number, Cycle time, Cycle end) {
    const Load load = l1.queue[l1.head];
    Flight& flight = flights_[load.flight];
    const LoadShape& shape = *flight.shape;
    const Timing& timing = rules_.timing;
    const bool banks = timing.l1_port == L1Port::banks;
    const Cycle step = rules_.ideal.infinite_bandwidth ? 0 : 1;
    const std::uint32_t k = flight.at_port;
    const auto most_sectors =
        std::max(1u, static_cast<std::uint32_t>(timing.l1_bytes_per_cycle / rules_.gpu.l1().sector_bytes));
    const Cycle begin = time;
    std::uint32_t used = 0, tags = 0;          // of this cycle: banks taken or sectors; lines
    std::uint64_t before = ~std::uint64_t{0};  // the sector looked up last, in this request
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
            const bool new_line =
                before == ~std::uint64_t{0} || sector >> rules_.line_of_sector != before >> rules_.line_of_sector;
            const std::uint32_t bank = 1u << (sector & (timing.l1_banks - 1));
            const bool full =
                banks ? (used & bank) != 0 : used == most_sectors || (new_line && tags == timing.tags_per_cycle);
            if (full) {
                time += step;
                used = tags = 0;
            }
            if (time >= end) return end;
            if (!look_up(l1, number, load.flight, sector, flight.entries[l1.position], time)) {
                const Cycle retry = l1.arrivals.empty() ? end : std::max(time + 1, l1.arrivals.front());
                return std::min(retry, end);
            }
            used = banks ? used | bank : used + 1;
            tags += new_line;
            before = sector;
        }
        if (first && flight.visit.ends_group(l1.position / 2)) {
            before = ~std::uint64_t{0};
            if (l1.position + 1 < 2 * flight.visit.count()) {  // the next request has a cycle of its own
                time += step;
                used = tags = 0;
            }
        }
    }
    l1.position = 0;
    time += step;
    statistics.l1_port.busy += static_cast<double>(time - begin);
    ++l1.head;
    if (l1.head == l1.queue.size()) {
        l1.queue.clear();
        l1.head = 0;
    }
    --scheduler_of(load.flight).queued;
    if (++flight.at_port == shape.loads && flight.unresolved == 0) visit_done(load.flight);
    return time;
}

}  // namespace raycache::cachesim
