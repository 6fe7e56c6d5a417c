#include "cachesim/replay/timed/port.hpp"

#include <algorithm>
#include <utility>

namespace raycache::cachesim {

Port::Port(const TimedRules& rules, LineIds& ids, std::uint16_t sm, std::uint8_t number, LoadData* data,
           std::vector<MissRequest>& lacks)
    : rules_(rules),
      ids_(ids),
      sm_(sm),
      number_(number),
      data_(data),
      lacks_(lacks),
      cache_(rules.gpu.l1(), sm * rules.gpu.l1_per_sm + number, rules.timing.l1_mshrs),
      tags_(rules.timing, rules.gpu.l1().sector_bytes),
      banks_(rules.timing, rules.gpu.l1().sector_bytes) {}

void Port::end_kernel(bool keep) {
    free_ = 0;
    if (!keep) cache_ = TimedCache(rules_.gpu.l1(), sm_ * rules_.gpu.l1_per_sm + number_, rules_.timing.l1_mshrs);
}

std::optional<Port::Load> Port::serve(Cycle now, Cycle end) {
    return rules_.timing.l1_port == L1Port::banks ? serve_by(banks_, now, end) : serve_by(tags_, now, end);
}

template <class Clock>
std::optional<Port::Load> Port::serve_by(Clock& clock, Cycle now, Cycle end) {
    const Load load = queue_.front();
    const bool passed = !load.visit->shape->apart || rules_.path == PortPath::rule ? follow<AnyWalk>(clock, now, end)
                        : can_repeat(now, end)                                     ? repeat(now, end)
                                                                                   : follow<ApartWalk>(clock, now, end);
    if (!passed) return std::nullopt;
    queue_.pop();
    place_ = {};
    return load;
}

/// The rule. Sector after sector waits for the clock, and is looked up; one that finds no room for its miss holds up
/// the load. A group of lanes begins a cycle after the one before; groups without an active lane pass, too, if
/// Timing::empty_request_cycles says so. Whether the load has passed; if not, it goes on when the port is free.
template <class Walk, class Clock>
bool Port::follow(Clock& kept, Cycle now, Cycle end) {
    const Load load = queue_.front();
    VisitAtPort& at = *load.visit;
    SectorCache& lines = cache_.lines();
    SectorCache::Line* const line = lines.lines();
    const bool lru = lines.is_lru(), perfect = rules_.ideal.perfect_l1, unlimited = rules_.ideal.infinite_bandwidth;
    const Cycle step = unlimited ? 0 : 1, empty = step * rules_.timing.empty_request_cycles;
    Walk walk(rules_, ids_, *at.shape, at.region, at.visit, load.number, place_);
    Clock clock = kept;
    std::uint32_t used = lines.take_time(walk.most());
    // For later loads of the visit: which sectors an element reads, counted from that of the first load.
    const bool records = Walk::apart && at.shape->steady && lru && !perfect && load.number == 0 && place_.element == 0;
    const std::uint32_t reads = records ? (2u << ((at.shape->loads - 1) >> at.shape->sector_of_piece)) - 1 : 0;
    if (records) at.found_since = used;
    Cycle time = now;
    if (!Walk::apart && !std::exchange(place_.begun, true)) time += empty * at.visit.empty_before(0);
    Cycle group = time;  // it can begin
    std::uint64_t hits = 0;
    std::uint32_t there = 0, new_lines = 0;
    bool room = true;
    const auto drain = [&](Cycle until) {  // lines that arrive are used, too (Allocate::on_fill)
        if (cache_.next_arrival() > until) [[likely]]
            return;
        if (lru) lines.give_time(used);
        cache_.drain(until);
        if (lru) used = lines.take_time(walk.most());
    };
    if (Walk::apart) drain(time);
    LoadStep found = LoadStep::end;
    while ((found = walk.find()) != LoadStep::end) {
        if (!Walk::apart && found == LoadStep::group) {
            group = time += step + empty * at.visit.empty_before(walk.place().element);
            continue;
        }
        const bool new_line = walk.new_line();
        const Cycle ready = unlimited ? time : clock.ready(walk.sector(), new_line, time);
        if (ready >= end) {
            time = ready;
            break;
        }
        if (!Walk::apart || ready != time) drain(ready);
        time = ready;
        if (records) at.cycle[walk.place().element] = static_cast<std::uint8_t>(time - now);
        if (perfect) {
            ++hits;
        } else {
            const std::uint32_t id = walk.id(), in_line = walk.in_line();
            std::uint32_t& known = at.entries[walk.entry()];
            std::uint32_t entry = known;
            if (line[entry].id != id) entry = lines.find(id);
            if (entry != none && (line[entry].present >> in_line & 1)) [[likely]] {
                known = entry;
                if (lru)
                    line[entry].used = ++used;
                else
                    lines.use(entry);
                ++hits;
                if (records)
                    there |= std::uint32_t{(line[entry].present >> in_line & reads) == reads} << walk.place().element;
            } else {
                if (lru) lines.give_time(used);
                room = miss(load, in_line, id, entry, time);
                if (lru) used = lines.take_time(walk.most());
                if (entry != none) known = entry;
                if (!room) break;
            }
        }
        clock.take(walk.sector(), new_line, time);
        new_lines += new_line;
        walk.next();
    }
    kept = clock;
    if (lru) lines.give_time(used);
    counts_.answers.hits += hits;
    if (Clock::counts_tags) counts_.tags += new_lines;
    if (found != LoadStep::end) {
        place_ = walk.place();
        place_.begun = true;
        at.there = 0;
        if (room)
            free_ = std::max(end, group);  // the rest in the next window
        else
            try_again(time, end);
        return false;
    }
    data_[load.data].arrival = std::max(data_[load.data].arrival, time);
    if (load.number == 0) {
        at.there = there;
        at.lines = Clock::counts_tags ? new_lines : 0;
    }
    end_load(now, time + step + empty * at.visit.empty_behind());
    return true;
}

/// The load at the front asks for what the first one of its visit asked for, a load further on, and begins a cycle of
/// its own.
bool Port::can_repeat(Cycle now, Cycle end) {
    const Load& load = queue_.front();
    const VisitAtPort& at = *load.visit;
    if (load.number == 0 || at.there == 0 || place_.element != 0) return false;
    const Cycle last = now + at.cycle[at.visit.count() - 1];
    if (rules_.gpu.l1().allocate == Allocate::on_fill) {  // what arrives evicts lines
        cache_.drain(now);
        if (cache_.next_arrival() <= last) return false;
    }
    const bool even = rules_.timing.l1_port == L1Port::banks || rules_.port_sectors != 0;
    return even && last < end && cache_.lines().newest_evicted() <= at.found_since;
}

/// Some of what the load asks for the first load found: there it is still, as no line that was used since has been
/// evicted. Loads of LoadShape::steady take the port equally long. The rest is looked up.
bool Port::repeat(Cycle now, Cycle end) {
    const Load load = queue_.front();
    VisitAtPort& at = *load.visit;
    LoadData& data = data_[load.data];
    const LoadShape& shape = *at.shape;
    SectorCache& lines = cache_.lines();
    SectorCache::Line* const line = lines.lines();
    const std::uint32_t count = at.visit.count(), k = load.number;
    const Cycle step = rules_.ideal.infinite_bandwidth ? 0 : 1;
    const std::uint32_t first_use = lines.take_time(traces::warp_lanes) + 1;  // of element i: first_use + i
    const std::uint32_t in_visit = ~std::uint32_t{0} >> (traces::warp_lanes - count);
    std::uint32_t next = 0;
    const auto use_up_to = [&](std::uint32_t i) {
        for (; next < i; ++next) line[at.entries[next]].used = first_use + next;
    };
    const auto line_of = [&](std::uint32_t i) {
        return shape.first_id + ((at.visit[i] + k) >> shape.sector_of_piece >> rules_.line_of_sector);
    };
    for (std::uint32_t left = in_visit & ~at.there; left; left &= left - 1) {
        const auto i = static_cast<std::uint32_t>(std::countr_zero(left));
        const Cycle time = now + at.cycle[i] * step;
        use_up_to(i);
        lines.give_time(first_use + i - 1);
        const std::uint32_t sector = (at.visit[i] + k) >> shape.sector_of_piece;
        if (!look_up(load, line_of(i), sector & (rules_.sectors_per_line - 1), at.entries[i], time)) {
            place_.element = i;
            std::uint32_t before = none;
            for (std::uint32_t e = 0; e < i && at.lines > 0; ++e) {
                counts_.tags += line_of(e) != before;
                before = line_of(e);
            }
            counts_.answers.hits += static_cast<unsigned>(std::popcount(at.there & ((std::uint32_t{1} << i) - 1)));
            try_again(time, end);
            return false;
        }
        next = i + 1;
    }
    use_up_to(count);
    lines.give_time(first_use + count - 1);
    counts_.tags += at.lines;
    counts_.answers.hits += static_cast<unsigned>(std::popcount(at.there));
    const Cycle last = now + at.cycle[count - 1] * step;
    data.arrival = std::max(data.arrival, last);
    end_load(now, last + step);
    return true;
}

/// The load has passed: `end` is when the next can begin.
void Port::end_load(Cycle begin, Cycle end) {
    counts_.busy += static_cast<double>(end - begin);
    free_ = end;
}

/// Looks up one sector of a line; false if the L1 has no room for another miss. `known`: where the line was last.
bool Port::look_up(const Load& load, std::uint32_t id, std::uint32_t sector, std::uint32_t& known, Cycle time) {
    SectorCache& lines = cache_.lines();
    cache_.drain(time);
    std::uint32_t entry = lines[known].id == id ? known : lines.find(id);
    bool done = true;
    if (entry != none && (lines[entry].present >> sector & 1)) {
        lines.use(entry);
        ++counts_.answers.hits;
    } else {
        done = miss(load, sector, id, entry, time);
    }
    if (entry != none) known = entry;
    return done;
}

/// What the L1 does not have: false if it has no room for another miss. `entry`: of the line, or none.
bool Port::miss(const Load& load, std::uint32_t sector, std::uint32_t id, std::uint32_t& entry, Cycle time) {
    LoadData& data = data_[load.data];
    SectorCache& lines = cache_.lines();
    MissRegisters& registers = cache_.registers();
    if (const std::uint32_t pending = cache_.find_pending(id, sector, entry); pending != none) {
        MissRegisters::Register& r = registers[pending];
        if (r.merged >= rules_.timing.l1_mshr_merges) return false;
        if (entry != none) lines.use(entry);
        ++r.merged;
        ++counts_.answers.merges;
        if (r.arrival != never) {
            data.arrival = std::max(data.arrival, r.arrival);
        } else {
            registers.wait(pending, load.data);
            ++data.unresolved;
        }
        return true;
    }
    if (registers.full()) return false;
    const std::uint64_t line = ids_.line(id, load.visit->region);
    const bool line_there = entry != none;
    const std::uint64_t set = line_there ? 0 : rules_.maps[0](line);
    const std::uint32_t sent = cache_.send_for(id, sector, set, entry, time);
    if (sent == none) return false;
    if (line_there) lines.use(entry);
    ++(line_there ? counts_.answers.sector_misses : counts_.answers.line_misses);
    registers.wait(sent, load.data);
    ++data.unresolved;
    const auto ask = [&](std::uint32_t register_number, std::uint32_t of_line) {
        lacks_.push_back({time, line, id, register_number, sm_, static_cast<std::uint8_t>(of_line), number_});
    };
    ask(sent, sector);
    if (rules_.fill_sectors[0] > 1)
        cache_.send_for_neighbours(rules_.fill_sectors[0], id, sector, set, entry, time, ask);
    return true;
}

}  // namespace raycache::cachesim
