#include "cachesim/replay/timed/timed_cache.hpp"

#include "cachesim/cache/registry.hpp"

namespace raycache::cachesim {

namespace {

SectorCache make_lines(const CacheGeometry& g, unsigned number) {
    auto order = make_victim_order(g, number);
    const auto policy = g.policy == "lru"    ? SectorCache::Policy::lru
                        : g.policy == "fifo" ? SectorCache::Policy::fifo
                                             : SectorCache::Policy::ordered;
    return {g.slices * g.sets, g.ways, policy, std::move(order)};
}

}  // namespace

TimedCache::TimedCache(const CacheGeometry& geometry, unsigned number, std::uint32_t registers)
    : lines_(make_lines(geometry, number)),
      registers_(registers, geometry.allocate == Allocate::on_fill ? registers : lines_.entries()) {
    if (geometry.allocate == Allocate::on_miss) return;
    coming_.emplace(1, registers, SectorCache::Policy::lru);
    set_of_.resize(registers);
}

std::uint32_t TimedCache::find_pending(std::uint32_t line, std::uint32_t sector, std::uint32_t entry) const {
    if (coming_) {
        const std::uint32_t coming = coming_->find(line);
        if (coming == none || !((*coming_)[coming].pending >> sector & 1)) return none;
        return registers_.find(coming, sector);
    }
    if (entry == none || !(lines_[entry].pending >> sector & 1)) return none;
    return registers_.find(entry, sector);
}

std::uint32_t TimedCache::send_for(std::uint32_t line, std::uint32_t sector, std::uint64_t set, std::uint32_t& entry,
                                   Cycle now) {
    std::uint32_t holder = entry;
    if (coming_) {
        holder = coming_->find(line);
        if (holder == none) holder = coming_->replace(0, line);
        if (holder == none) return none;
        set_of_[holder] = set;
        (*coming_)[holder].pending |= 1u << sector;
    } else {
        if (holder == none) holder = lines_.replace(set, line);
        if (holder == none) return none;
        lines_[holder].pending |= 1u << sector;
        entry = holder;
    }
    return registers_.take(holder, sector, now);
}

void TimedCache::take_in() {
    const std::uint32_t number = arrivals_.front().number;
    arrivals_.pop();
    next_arrival_ = arrivals_.empty() ? never : arrivals_.front().time;
    const MissRegisters::Register& r = registers_[number];
    const std::uint32_t sector = 1u << r.sector;
    if (coming_) {
        SectorCache::Line& coming = (*coming_)[r.entry];
        std::uint32_t entry = lines_.find(coming.id);
        if (entry == none) entry = lines_.replace(set_of_[r.entry], coming.id);  // no line is on its way, so one can go
        lines_[entry].present |= sector;
        coming.pending &= ~sector;
        if (!coming.pending) coming_->remove(r.entry);
    } else {
        SectorCache::Line& line = lines_[r.entry];
        line.pending &= ~sector;
        line.present |= sector;
    }
    registers_.give_back(number);
}

}  // namespace raycache::cachesim
