// The L1s of an SM: the port that loads go through, and look-ups.
#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "cachesim/replay/timed/timed_sm.hpp"

namespace raycache::cachesim {

/// Looks up one sector of a line; false if the L1 has no room for another miss. `known`: where the line was last.
bool TimedSm::look_up(L1& l1, std::uint8_t number, const Load& load, std::uint32_t id, std::uint32_t sector,
                      std::uint32_t& known, Cycle time) {
    SectorCache& lines = l1.cache.lines();
    l1.cache.drain(time);
    std::uint32_t entry = lines[known].id == id ? known : lines.find(id);
    bool done = true;
    if (entry != none && (lines[entry].present >> sector & 1)) {
        lines.use(entry);
        ++statistics.l1.hits;
    } else {
        done = miss(l1, number, load, sector, id, entry, time);
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
    const Flight& flight = flights_[l1.queue.front().flight];
    const bool even = rules_.timing.l1_port == L1Port::banks || rules_.port_sectors != 0;
    if (!flight.shape->apart || !even) return serve_any(number, time, end);
    return rules_.timing.l1_port == L1Port::banks ? serve_apart<L1Port::banks>(number, time, end)
                                                  : serve_apart<L1Port::tags>(number, time, end);
}

/// The load has passed the port: `end` is when the next can begin.
Cycle TimedSm::end_load(L1& l1, Cycle begin, Cycle end) {
    const Load load = l1.queue.front();
    Flight& flight = flights_[load.flight];
    l1.position = l1.sector = 0;
    l1.begun = false;
    l1.queue.pop();
    statistics.l1_port.busy += static_cast<double>(end - begin);
    if (!flow_) {
        --schedulers_[flight.scheduler].queued;
        note(flight.scheduler);
    }
    Data& data = data_[load.data];
    data.asked = ++flight.at_port == flight.shape->loads || flow_;
    if (data.asked && data.unresolved == 0) data_known(load.data);
    return end;
}

/// A later load of a visit whose first load found some of what it asks for: there it is still, if no line that was used
/// since has been evicted. LoadShape::steady.
Cycle TimedSm::serve_later(std::uint8_t number, Cycle begin, Cycle end) {
    L1& l1 = l1s_[number];
    const Load load = l1.queue.front();
    Flight& flight = flights_[load.flight];
    Data& data = data_[load.data];
    const LoadShape& shape = *flight.shape;
    SectorCache& lines = l1.cache.lines();
    SectorCache::Line* const line = lines.lines();
    const std::uint32_t count = flight.visit.count(), k = load.number;
    const Cycle step = rules_.ideal.infinite_bandwidth ? 0 : 1;
    const std::uint32_t first_use = lines.take_time(traces::warp_lanes) + 1;  // of element i: first_use + i
    const std::uint32_t in_visit = ~std::uint32_t{0} >> (traces::warp_lanes - count);
    std::uint32_t next = 0;
    const auto use_up_to = [&](std::uint32_t i) {
        for (; next < i; ++next) line[flight.entries[next]].used = first_use + next;
    };
    const auto line_of = [&](std::uint32_t i) {
        return shape.first_id + ((flight.visit[i] + k) >> shape.sector_of_piece >> rules_.line_of_sector);
    };
    for (std::uint32_t left = in_visit & ~flight.there; left; left &= left - 1) {
        const auto i = static_cast<std::uint32_t>(std::countr_zero(left));
        const Cycle time = begin + flight.cycle[i] * step;
        use_up_to(i);
        lines.give_time(first_use + i - 1);
        bool done = false;
        if (time < end) {
            const std::uint32_t sector = (flight.visit[i] + k) >> shape.sector_of_piece;
            done =
                look_up(l1, number, load, line_of(i), sector & (rules_.sectors_per_line - 1), flight.entries[i], time);
        }
        if (!done) {
            l1.position = i;
            std::uint32_t before = none;
            for (std::uint32_t e = 0; e < i && flight.lines > 0; ++e) {
                statistics.l1_tags.busy += line_of(e) != before;
                before = line_of(e);
            }
            statistics.l1.hits += std::popcount(flight.there & ((std::uint32_t{1} << i) - 1));
            data.arrival = std::max(data.arrival, std::min(time, end - 1));
            return time < end ? retry_time(l1, time, end) : end;
        }
        next = i + 1;
    }
    use_up_to(count);
    lines.give_time(first_use + count - 1);
    statistics.l1_tags.busy += flight.lines;
    statistics.l1.hits += std::popcount(flight.there);
    const Cycle last = begin + flight.cycle[count - 1] * step;
    data.arrival = std::max(data.arrival, last);
    return end_load(l1, begin, last + step);
}

/// LoadShape::apart.
template <L1Port port>
Cycle TimedSm::serve_apart(std::uint8_t number, Cycle time, Cycle end) {
    L1& l1 = l1s_[number];
    const Load load = l1.queue.front();
    Flight& flight = flights_[load.flight];
    Data& data = data_[load.data];
    const LoadShape& shape = *flight.shape;
    const std::uint32_t k = load.number;
    if (k > 0 && flight.there && l1.position == 0 && time + flight.cycle[flight.visit.count() - 1] < end &&
        l1.cache.lines().newest_evicted() <= flight.found_since)
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
    std::uint32_t lines_asked = 0;
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
            lines_asked += new_line;
            id_before = id;
        }
        if (first) flight.cycle[i] = static_cast<std::uint8_t>(time - begin);
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
            done = miss(l1, number, load, in_line, id, entry, time);
            if (lru) used = lines.take_time(traces::warp_lanes);
            if (entry != none) known = entry;
            if (!done) {
                if constexpr (port == L1Port::tags)
                    lines_asked -=
                        i == 0 || id != first_id + ((pieces[i - 1] + k) >> sector_of_piece >> line_of_sector);
                break;
            }
        }
    }
    if (lru) lines.give_time(used);
    statistics.l1.hits += hits;
    statistics.l1_tags.busy += lines_asked;
    if (i < count) {  // the rest when there is room, or in the next window
        l1.position = i;
        flight.there = 0;
        data.arrival = std::max(data.arrival, std::min(time, end - 1));
        return time >= end ? end : retry_time(l1, time, end);
    }
    data.arrival = std::max(data.arrival, time);
    if (k == 0) {
        flight.there = first && shape.steady && lru && !perfect ? there : 0;
        flight.lines = lines_asked;
    }
    return end_load(l1, begin, time + step);
}

/// L1Port::tags: when the tag stage and the data path are free for one more sector, of another line or not.
Cycle TimedSm::port_ready(const L1& l1, bool new_line, Cycle time) const {
    if (rules_.ideal.infinite_bandwidth) return time;
    constexpr double rounding = 1e-6;
    time = std::max(time, static_cast<Cycle>(l1.data_free + rounding));
    return new_line ? std::max(time, l1.tags_free / rules_.timing.tags_per_cycle) : time;
}
void TimedSm::take_port(L1& l1, bool new_line, Cycle time) {
    l1.data_free = std::max(l1.data_free, static_cast<double>(time)) + rules_.data_cost;
    if (!new_line) return;
    l1.tags_free = std::max(l1.tags_free, time * rules_.timing.tags_per_cycle) + 1;
    statistics.l1_tags.busy += 1;
}

/// Any load: each group of lanes by itself, its sectors in descending order. Groups without an active lane pass, too,
/// if Timing::empty_request_cycles says so.
Cycle TimedSm::serve_any(std::uint8_t number, Cycle time, Cycle end) {
    L1& l1 = l1s_[number];
    const Load load = l1.queue.front();
    Flight& flight = flights_[load.flight];
    Data& data = data_[load.data];
    const Visit& visit = flight.visit;
    const LoadShape& shape = *flight.shape;
    const bool banks = rules_.timing.l1_port == L1Port::banks;
    const Cycle step = rules_.ideal.infinite_bandwidth ? 0 : 1;
    const Cycle empty = step * rules_.timing.empty_request_cycles;
    const std::uint32_t k = load.number, bank_mask = rules_.timing.l1_banks - 1;
    const Cycle begin = time;
    if (!std::exchange(l1.begun, true)) time += empty * visit.empty_before(0);
    Cycle group = time;            // it can begin
    std::uint32_t used = 0;        // banks taken in this cycle
    std::uint64_t before = never;  // the lowest sector of this group so far
    if (l1.sector > 0)
        before = shape.last_sector(visit[l1.position], k) - l1.sector + 1;
    else if (l1.position > 0 && !visit.ends_group(l1.position - 1))
        before = shape.first_sector(visit[l1.position - 1], k);
    for (; l1.position < visit.count(); ++l1.position, l1.sector = 0) {
        const std::uint32_t place = visit[l1.position];
        const std::uint64_t first = shape.first_sector(place, k), last = shape.last_sector(place, k);
        for (; l1.sector <= last - first; ++l1.sector) {
            const std::uint64_t sector = last - l1.sector, line = sector >> rules_.line_of_sector;
            if (sector >= before) continue;
            const bool new_line = before == never || line != before >> rules_.line_of_sector;
            const std::uint32_t bank = 1u << (sector & bank_mask);
            if (!banks) {
                time = port_ready(l1, new_line, time);
            } else if (used & bank) {
                time += step;
                used = 0;
            }
            if (time >= end) return std::max(end, group);
            data.arrival = std::max(data.arrival, time);
            if (rules_.ideal.perfect_l1)
                ++statistics.l1.hits;
            else if (!look_up(l1, number, load, ids_.id(line, flight.region),
                              static_cast<std::uint32_t>(sector & (rules_.sectors_per_line - 1)),
                              flight.entries[2 * l1.position + (line & 1)], time))
                return retry_time(l1, time, end);
            if (banks)
                used |= bank;
            else
                take_port(l1, new_line, time);
            before = sector;
        }
        if (visit.ends_group(l1.position) && l1.position + 1 < visit.count()) {
            before = never;
            // the next group has a cycle of its own
            group = time += step + empty * visit.empty_before(l1.position + 1);
            used = 0;
        }
    }
    return end_load(l1, begin, time + step + empty * visit.empty_behind());
}

}  // namespace raycache::cachesim
