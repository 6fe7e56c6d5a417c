#include "cachesim/replay/timed/sector_cache.hpp"

#include <algorithm>
#include <bit>
#include <utility>

namespace raycache::cachesim {

namespace {
/// Up to here a search of all ways is as fast as a queue.
constexpr std::uint64_t few_ways = 24;
}  // namespace

SectorCache::SectorCache(std::uint64_t sets, std::uint64_t ways, Policy policy, std::unique_ptr<VictimOrder> order)
    : ways_(ways),
      policy_(policy),
      order_(std::move(order)),
      by_ways_(ways),
      shift_(64 - std::countr_zero(std::bit_ceil(2 * sets * ways))),
      lines_(sets * ways),
      slots_(std::bit_ceil(2 * sets * ways)),
      queues_(policy != Policy::ordered && ways > few_ways ? sets : 0) {}

void SectorCache::use_ordered(std::uint32_t entry) {
    const auto [set, way] = by_ways_(entry);
    order_->use(set, way);
}

std::uint32_t SectorCache::replace(std::uint64_t set, std::uint32_t id) {
    const std::uint32_t entry = victim(set);
    if (entry == none) return none;
    if (lines_[entry].id != none) {
        newest_evicted_ = std::max(newest_evicted_, lines_[entry].used);
        unlink(entry);
    }
    lines_[entry] = {id, 0, 0, 0};
    if (policy_ == Policy::ordered)
        use_ordered(entry);
    else
        lines_[entry].used = tick();
    std::uint32_t at = home(id);
    while (slots_[at].entry != none) at = next(at);
    slots_[at] = {id, entry};
    return entry;
}

void SectorCache::remove(std::uint32_t entry) {
    unlink(entry);
    lines_[entry] = {};
}

/// Linear probing without tombstones (Knuth 3, section 6.4, algorithm R): what would no longer be found moves up.
void SectorCache::unlink(std::uint32_t entry) {
    const auto mask = static_cast<std::uint32_t>(slots_.size() - 1);
    std::uint32_t hole = home(lines_[entry].id);
    while (slots_[hole].entry != entry) hole = next(hole);
    for (std::uint32_t at = next(hole); slots_[at].entry != none; at = next(at)) {
        const std::uint32_t from = home(slots_[at].id);
        if (((at - from) & mask) < ((at - hole) & mask)) continue;
        slots_[hole] = slots_[at];
        hole = at;
    }
    slots_[hole] = {};
}

std::uint32_t SectorCache::victim(std::uint64_t set) {
    const auto first = static_cast<std::uint32_t>(set * ways_);
    if (policy_ == Policy::ordered) {
        for (std::uint32_t way = 0; way < ways_; ++way)
            if (lines_[first + way].id == none) return first + way;
        const std::uint64_t named = order_->victim(set);
        for (std::uint64_t i = 0; i < ways_; ++i) {
            const std::uint64_t way = named + i < ways_ ? named + i : named + i - ways_;
            if (!lines_[first + way].pending) return static_cast<std::uint32_t>(first + way);
        }
        return none;
    }
    if (queues_.empty()) return oldest(set);
    Queue& queue = queues_[set];
    for (int attempt = 0; attempt < 2; ++attempt) {
        for (std::size_t i = queue.begin; i < queue.candidates.size(); ++i) {
            const Candidate c = queue.candidates[i];
            const Line& line = lines_[c.entry];
            if (line.used == c.used && !line.pending) return c.entry;
            if (i == queue.begin && line.used != c.used) ++queue.begin;
        }
        if (attempt == 0) refill(queue, set);
    }
    return oldest(set);  // all candidates have sectors on their way
}

std::uint32_t SectorCache::oldest(std::uint64_t set) const {
    const auto first = static_cast<std::uint32_t>(set * ways_);
    std::uint32_t found = none, used = 0;
    for (std::uint32_t entry = first; entry < first + ways_; ++entry) {
        const Line& line = lines_[entry];
        if (line.pending || (found != none && line.used >= used)) continue;
        found = entry;
        used = line.used;
    }
    return found;
}

/// Some of the oldest lines of the set: those last used before a time that moves on as lines go. Whatever is used from
/// now on is younger than all of them.
void SectorCache::refill(Queue& queue, std::uint64_t set) const {
    const auto first = static_cast<std::uint32_t>(set * ways_);
    queue.begin = 0;
    queue.candidates.clear();
    std::uint32_t step = queue.step;
    while (queue.candidates.empty()) {
        const std::uint32_t until = now_ - queue.horizon <= step ? now_ : queue.horizon + step;
        for (std::uint32_t entry = first; entry < first + ways_; ++entry)
            if (lines_[entry].used <= until) queue.candidates.push_back({lines_[entry].used, entry});
        queue.horizon = until;
        if (queue.candidates.size() < ways_ / 16) step = queue.step = std::min(step, end_of_time / 4) * 2;
        if (queue.candidates.size() > ways_ / 4) queue.step = std::max(1u, queue.step / 2);
    }
    std::sort(queue.candidates.begin(), queue.candidates.end(), [](const Candidate& a, const Candidate& b) {
        return a.used != b.used ? a.used < b.used : a.entry < b.entry;
    });
}

/// Numbers the times in the lines from 1, in their order.
void SectorCache::start_time_anew() {
    std::vector<std::uint32_t> entries;
    for (std::uint32_t entry = 0; entry < lines_.size(); ++entry)
        if (lines_[entry].used) entries.push_back(entry);
    std::sort(entries.begin(), entries.end(),
              [this](std::uint32_t a, std::uint32_t b) { return lines_[a].used < lines_[b].used; });
    now_ = 0;
    for (const std::uint32_t entry : entries) lines_[entry].used = ++now_;
    for (Queue& queue : queues_) queue = {};
    newest_evicted_ = now_;  // to be on the safe side
}

}  // namespace raycache::cachesim
