// What the L1s of an SM lack: what is sent for, where it may go, and what comes back. An L2 of the core's own, too.
#include <algorithm>

#include "cachesim/replay/timed/timed_sm.hpp"

namespace raycache::cachesim {

namespace {

/// What a fill brings beside a missing sector that has been sent for, as far as there are registers.
template <class Sent>
void send_for_neighbours(TimedCache& cache, std::uint32_t fill_sectors, std::uint32_t line, std::uint32_t sector,
                         std::uint64_t set, std::uint32_t& entry, Cycle now, const Sent& sent) {
    const std::uint32_t first = sector / fill_sectors * fill_sectors;
    for (std::uint32_t s = first; s < first + fill_sectors && !cache.registers().full(); ++s) {
        if (entry != TimedCache::none && (cache.lines()[entry].present >> s & 1)) continue;
        if (cache.find_pending(line, s, entry) != TimedCache::none) continue;
        const std::uint32_t number = cache.send_for(line, s, set, entry, now);
        if (number != TimedCache::none) sent(number, s);
    }
}

}  // namespace

void TimedSm::wait(std::uint32_t& list, std::uint32_t who, std::uint8_t l1) { list = waiters_.take({who, list, l1}); }

/// The arrival of a sector that was sent for is known.
void TimedSm::arrive_in_l1(std::uint8_t number, std::uint32_t register_number, Cycle time) {
    TimedCache& cache = l1s_[number].cache;
    statistics.l1_mshrs.busy += static_cast<double>(cache.set_arrival(register_number, time));
    answer_free_ = std::max(answer_free_, time);
    std::uint32_t waiter = cache.registers()[register_number].waiters;
    while (waiter != none) {
        const Waiter w = waiters_[waiter];
        waiters_.give_back(waiter);
        waiter = w.next;
        Data& data = data_[w.who];
        data.arrival = std::max(data.arrival, answer_free_);
        if (rules_.timing.answers_per_cycle) ++answer_free_;
        if (--data.unresolved == 0 && data.asked) data_known(w.who);
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
        waiters_.give_back(waiter);
        waiter = w.next;
        arrive_in_l1(w.l1, w.who, reply.ready);
    }
    cache.registers()[reply.number].waiters = none;
}

/// What L1s ask of the core's L2, in order; the first that finds no room holds up the others.
void TimedSm::serve_private(Cycle now) {
    PrivateLevel& level = *private_;
    const Timing& timing = rules_.timing;
    const double cost = rules_.ideal.infinite_bandwidth ? 0 : rules_.gpu.l1().sector_bytes / timing.l2_bytes_per_cycle;
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
            const std::uint64_t set = line_there ? 0 : rules_.maps[1](request.line);
            const std::uint32_t number = level.cache.send_for(request.id, request.sector, set, entry, now);
            if (number == none) return;
            if (line_there) lines.use(entry);
            ++(line_there ? answers.sector_misses : answers.line_misses);
            wait(registers[number].waiters, request.number, request.l1);
            misses.push_back({now, request.line, request.id, number, number_, request.sector, 0});
            send_for_neighbours(level.cache, rules_.fill_sectors[1], request.id, request.sector, set, entry, now,
                                [&](std::uint32_t neighbour, std::uint32_t sector) {
                                    misses.push_back({now, request.line, request.id, neighbour, number_,
                                                      static_cast<std::uint8_t>(sector), 0});
                                });
        }
        level.free = std::max(level.free, static_cast<double>(now)) + cost;
        level.queue.pop();
    }
}

/// What the L1 does not have: false if it has no room for another miss. `entry`: of the line, or none.
bool TimedSm::miss(L1& l1, std::uint8_t number, const Load& load, std::uint32_t sector, std::uint32_t id,
                   std::uint32_t& entry, Cycle time) {
    Data& data = data_[load.data];
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
            data.arrival = std::max(data.arrival, r.arrival);
        } else {
            wait(r.waiters, load.data, number);
            ++data.unresolved;
        }
        return true;
    }
    if (registers.full()) return false;
    const std::uint64_t line = ids_.line(id, flights_[load.flight].region);
    const bool line_there = entry != none;
    const std::uint64_t set = line_there ? 0 : rules_.maps[0](line);
    const std::uint32_t sent = l1.cache.send_for(id, sector, set, entry, time);
    if (sent == none) return false;
    if (line_there) lines.use(entry);
    ++(line_there ? answers.sector_misses : answers.line_misses);
    wait(registers[sent].waiters, load.data, number);
    ++data.unresolved;
    const auto ask = [&](std::uint32_t register_number, std::uint32_t of_line) {
        const auto s = static_cast<std::uint8_t>(of_line);
        if (private_)
            private_->queue.push({time, line, id, register_number, s, number});
        else
            misses.push_back({time, line, id, register_number, number_, s, number});
    };
    ask(sent, sector);
    if (rules_.fill_sectors[0] > 1)
        send_for_neighbours(l1.cache, rules_.fill_sectors[0], id, sector, set, entry, time, ask);
    return true;
}

}  // namespace raycache::cachesim
