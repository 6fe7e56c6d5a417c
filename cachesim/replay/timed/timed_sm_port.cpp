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
    if (l1.fills) l1.fills->drain(time, l1.tags, rules_.l1_map);
    if (!l1.tags.holds(entry, line)) entry = l1.tags.find(line);
    const bool line_there = entry != SectorTags::none;
    const auto place_of = [&](std::uint32_t number_of_entry) {
        return std::size_t{number_of_entry} * rules_.sectors_per_line + sector;
    };
    const auto wait_at = [&](std::size_t place) {
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
    const auto merge = [&](std::size_t place, Cycle arrival) {
        if (l1.merges[place] >= rules_.timing.l1_mshr_merges) return false;
        if (line_there) l1.tags.use(entry);
        ++l1.merges[place];
        ++answers.merges;
        if (arrival == SectorTags::unknown)
            wait_at(place);
        else
            flight.arrival = std::max(flight.arrival, arrival);
        return true;
    };
    if (line_there && l1.tags.present(entry, sector)) {
        if (l1.tags.arrived(entry, sector, time)) {
            l1.tags.use(entry);
            ++answers.hits;
            return true;
        }
        return merge(place_of(entry), l1.tags.arrival(entry, sector));
    }
    if (l1.fills) {
        const std::uint32_t filling = l1.fills->find(line, sector);
        if (filling != SectorTags::none) {
            const bool merged = merge(place_of(l1.entries + filling), l1.fills->arrival(filling, sector));
            if (!line_there) entry = 0;
            return merged;
        }
    }
    for (; !l1.arrivals.empty() && l1.arrivals.front() <= time; l1.arrivals.pop()) --l1.under_way;
    if (l1.under_way >= rules_.timing.l1_mshrs) {
        if (!line_there) entry = 0;
        return false;
    }
    std::uint32_t holder;  // the entry that waits for the sector
    if (l1.fills) {
        holder = l1.fills->add(line, sector, SectorTags::unknown, time);
        if (holder != SectorTags::none) holder += l1.entries;
    } else {
        holder = line_there ? entry : l1.tags.replace(rules_.l1_map(line), line, time);
        if (holder != SectorTags::none) l1.tags.add(holder, sector, SectorTags::unknown);
    }
    if (line_there)
        l1.tags.use(entry);
    else
        entry = l1.fills || holder == SectorTags::none ? 0 : holder;
    if (holder == SectorTags::none) return false;
    ++(line_there ? answers.sector_misses : answers.line_misses);
    l1.merges[place_of(holder)] = 1;
    ++l1.under_way;
    wait_at(place_of(holder));
    misses.push_back({time, line, holder, number_, static_cast<std::uint8_t>(sector), number});
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
