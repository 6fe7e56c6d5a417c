#include "cachesim/analysis/lru_surface.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "traces/memory_budget.hpp"

namespace raycache::cachesim {

bool index_fits(const CacheGeometry& geometry, std::uint64_t sets) {
    if (geometry.index == SetIndex::ipoly) return sets == 16 || sets == 32 || sets == 64;
    if (geometry.index == SetIndex::parity)
        return geometry.index_masks.size() < 32 && std::uint64_t{1} << geometry.index_masks.size() == sets;
    return true;
}

CacheGeometry with_sets(CacheGeometry geometry, std::uint64_t sets) {
    if (!index_fits(geometry, sets)) geometry.index = SetIndex::xor_fold;
    geometry.sets = sets;
    return geometry;
}

CacheGeometry fully_associative(CacheGeometry geometry) {
    geometry.sets = geometry.slices = 1;
    geometry.index = SetIndex::modulo;
    geometry.slice_hash = SliceHash::modulo;
    return geometry;
}

namespace {

/// Evenly spread over 0 to 1: SplitMix64 (Steele, Lea, Flood 2014).
double spread(std::uint64_t line) {
    std::uint64_t z = line + 0x9e3779b97f4a7c15;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
    z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
    return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

}  // namespace

LruSurface::LruSurface(std::size_t level, std::span<const CacheGeometry> rows, double rate)
    : level_(level),
      line_bytes_(rows.front().line_bytes),
      sectors_(rows.front().line_bytes / rows.front().sector_bytes),
      rate_(rate) {
    for (const CacheGeometry& row : rows)
        rows_.push_back({LineMap(row),
                         static_cast<std::size_t>(row.slices * row.sets),
                         std::max(1u, row.fill_bytes / row.sector_bytes),
                         {},
                         {}});
}

LruSurface::Cache& LruSurface::cache(const ServedRequest& request) {
    if (request.sm >= caches_.size()) caches_.resize(request.sm + 1);
    auto& of_sm = caches_[request.sm];
    if (request.cache >= of_sm.size()) of_sm.resize(request.cache + 1);
    auto& cache = of_sm[request.cache];
    if (!cache) {
        cache = std::make_unique<Cache>();
        for (const Row& row : rows_) cache->rows.emplace_back(sectors_, row.fill_sectors, row.sets);
    }
    return *cache;
}

void LruSurface::look_up(Row& row, StackDistance& distances, std::uint32_t number, const ServedRequest& request) {
    const std::size_t set = row.sets == 1 ? 0 : static_cast<std::size_t>(row.map(request.address / line_bytes_));
    if (row.fill_sectors == 1) {
        distances.look_up(
            number, request.asked,
            [&](std::uint32_t distance, unsigned) {
                distance == StackDistance::never ? row.asked.add_first(1) : row.asked.add(distance, 1);
            },
            set);
        return;
    }
    std::uint32_t seen = 0;  // sectors of a group come, and go, together
    distances.look_up(
        number, request.asked,
        [&](std::uint32_t distance, unsigned sector) {
            const bool first = distance == StackDistance::never;
            first ? row.asked.add_first(1) : row.asked.add(distance, 1);
            if (seen >> sector & 1) return;
            const std::uint32_t group = distances.with_group(1u << sector);
            seen |= group;
            const auto size = static_cast<unsigned>(std::popcount(group));
            first ? row.fetched.add_first(size) : row.fetched.add(distance, size);
        },
        set);
}

void LruSurface::served(std::size_t /*level*/, std::span<const ServedRequest> requests) {
    look_ups_ += requests.size();
    if (rate_ >= 1) return follow(requests);
    sample_.clear();
    for (const ServedRequest& request : requests) {
        asked_ += static_cast<unsigned>(std::popcount(request.asked));
        if (spread(request.address / line_bytes_) < rate_) sample_.push_back(request);
    }
    follow(sample_);
}

void LruSurface::follow(std::span<const ServedRequest> requests) {
    of_.resize(requests.size());
    numbers_.resize(requests.size());
    for (std::size_t i = 0; i < requests.size(); ++i) {
        const ServedRequest& request = requests[i];
        Cache& cache = this->cache(request);
        if (request.line >= cache.numbers.size()) cache.numbers.resize(request.line + 1 + request.line / 4);
        std::uint32_t& number = cache.numbers[request.line];
        if (number == 0) {
            number = ++cache.count;
            ++lines_;
        }
        of_[i] = &cache;
        numbers_[i] = number - 1;
    }
    if (lines_ >= next_check_) {
        check_memory();
        next_check_ = lines_ + lines_between_checks;
    }
    constexpr std::size_t ahead = 16;
    for (std::size_t r = 0; r < rows_.size(); ++r) {
        for (std::size_t i = 0; i < requests.size(); ++i) {
            const std::size_t later = std::min(i + ahead, requests.size() - 1);
            of_[later]->rows[r].prefetch(numbers_[later]);
            look_up(rows_[r], of_[i]->rows[r], numbers_[i], requests[i]);
        }
    }
}

std::vector<WaysCurve> LruSurface::curves() const {
    std::vector<WaysCurve> all;
    for (const Row& row : rows_) {
        WaysCurve& curve = all.emplace_back();
        curve.followed = curve.fills = row.asked.asked();
        curve.asked = rate_ < 1 ? asked_ : curve.followed;
        curve.rate = rate_;
        curve.hits = row.asked.hits_by_ways();
        if (row.fill_sectors == 1) continue;
        curve.fills = row.fetched.asked();
        curve.spared = row.fetched.hits_by_ways();
    }
    return all;
}

void LruSurface::check_memory() const {
    if (const std::uint64_t found = bytes(), limit = memory_limit(); found > limit)
        throw MemoryError(
            fmt::format("curve: expected curves of one launch in at most {}, found {} so far; ask for fewer numbers of "
                        "sets, for one level, a sample (--sampled), a smaller picture, or raise --memory-limit",
                        size_text(limit), size_text(found)));
}

std::size_t LruSurface::bytes() const {
    std::size_t sum = of_.capacity() * (sizeof(void*) + sizeof(numbers_[0]));
    for (const auto& of_sm : caches_)
        for (const auto& cache : of_sm) {
            if (!cache) continue;
            sum += cache->numbers.capacity() * sizeof(cache->numbers[0]);
            for (const StackDistance& row : cache->rows) sum += row.bytes();
        }
    return sum;
}

}  // namespace raycache::cachesim
