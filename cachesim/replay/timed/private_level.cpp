#include "cachesim/replay/timed/private_level.hpp"

#include <algorithm>

namespace raycache::cachesim {

PrivateLevel::PrivateLevel(const TimedRules& rules, std::uint16_t sm)
    : rules_(rules),
      sm_(sm),
      cost_(rules.ideal.infinite_bandwidth ? 0 : rules.gpu.l1().sector_bytes / rules.timing.l2_bytes_per_cycle),
      latency_(rules.ideal.no_added_latency ? 0 : rules.timing.l2_latency - rules.timing.l1_latency),
      cache_(rules.gpu.levels[1], sm, rules.timing.l2_mshrs) {}

void PrivateLevel::serve(Cycle now, std::vector<MissRequest>& lacks, std::vector<Answer>& answers) {
    while (!queue_.empty() && free_ <= static_cast<double>(now)) {
        if (!serve(queue_.front(), now, lacks, answers)) return;
        free_ = std::max(free_, static_cast<double>(now)) + cost_;
        queue_.pop();
    }
}

/// False if there is no room for it.
bool PrivateLevel::serve(const MissRequest& request, Cycle now, std::vector<MissRequest>& lacks,
                         std::vector<Answer>& answers) {
    cache_.drain(now);
    SectorCache& lines = cache_.lines();
    MissRegisters& registers = cache_.registers();
    std::uint32_t entry = lines.find(request.id);
    if (entry != TimedCache::none && (lines[entry].present >> request.sector & 1)) {
        lines.use(entry);
        ++counts_.hits;
        answers.push_back({now + latency_, request.number, request.l1});
        return true;
    }
    if (const auto pending = cache_.find_pending(request.id, request.sector, entry); pending != TimedCache::none) {
        if (registers[pending].merged >= rules_.timing.l2_mshr_merges) return false;
        if (entry != TimedCache::none) lines.use(entry);
        ++registers[pending].merged;
        ++counts_.merges;
        if (registers[pending].arrival != never)
            answers.push_back({registers[pending].arrival, request.number, request.l1});
        else
            registers.wait(pending, request.number, request.l1);
        return true;
    }
    if (registers.full()) return false;
    const bool line_there = entry != TimedCache::none;
    const std::uint64_t set = line_there ? 0 : rules_.maps[1](request.line);
    const std::uint32_t number = cache_.send_for(request.id, request.sector, set, entry, now);
    if (number == TimedCache::none) return false;
    if (line_there) lines.use(entry);
    ++(line_there ? counts_.sector_misses : counts_.line_misses);
    registers.wait(number, request.number, request.l1);
    const auto send = [&](std::uint32_t register_number, std::uint32_t sector) {
        lacks.push_back({now, request.line, request.id, register_number, sm_, static_cast<std::uint8_t>(sector), 0});
    };
    send(number, request.sector);
    cache_.send_for_neighbours(rules_.fill_sectors[1], request.id, request.sector, set, entry, now, send);
    return true;
}

void PrivateLevel::deliver(const MemorySide::Reply& reply, std::vector<Answer>& answers) {
    cache_.set_arrival(reply.number, reply.ready);
    cache_.registers().tell_waiters(reply.number, [&](std::uint32_t number, std::uint8_t l1) {
        answers.push_back({reply.ready, number, l1});
    });
}

}  // namespace raycache::cachesim
