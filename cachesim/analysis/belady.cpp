#include "cachesim/analysis/belady.hpp"

#include <algorithm>
#include <bit>
#include <queue>

#include "cachesim/cache/fill.hpp"
#include "cachesim/cache/line_map.hpp"

namespace raycache::cachesim {

namespace {

constexpr std::uint32_t no_next = ~std::uint32_t{0};

/// For each look-up, which one is the next of the same line.
template <class LookUps>
std::vector<std::uint32_t> next_uses(const LookUps& look_ups, std::size_t lines) {
    std::vector<std::uint32_t> next(look_ups.size()), at(lines, no_next);
    for (std::size_t i = look_ups.size(); i-- > 0;) {
        next[i] = at[look_ups[i].line];
        at[look_ups[i].line] = static_cast<std::uint32_t>(i);
    }
    return next;
}

/// A line in a cache; gone where `present` is 0.
struct HeldLine {
    std::uint32_t present = 0, next = no_next;
};

/// Lines of a set, the one that is wanted last on top; entries of lines that were looked up again since are stale.
struct HeldSet {
    std::priority_queue<std::pair<std::uint32_t, std::uint32_t>> by_next;
    std::uint64_t lines = 0;
};

}  // namespace

void BeladyCaches::served(std::size_t /*level*/, std::span<const ServedRequest> requests) {
    budget_.charge(requests.size() * sizeof(LookUp), "curve", "look-ups kept for Belady's optimum");
    for (const ServedRequest& request : requests) {
        if (request.line >= addresses_.size()) addresses_.resize(request.line + 1 + request.line / 4);
        addresses_[request.line] = request.address;
        look_ups_[{request.sm, request.cache}].push_back({request.line, request.asked});
    }
}

PolicyCounts BeladyCaches::counts_of_cache(const CacheGeometry& geometry, const std::vector<LookUp>& look_ups) const {
    const LineMap map(geometry);
    const Fill fill(geometry);
    const std::vector<std::uint32_t> next = next_uses(look_ups, addresses_.size());
    std::vector<HeldLine> held(addresses_.size());
    std::vector<HeldSet> sets(geometry.slices * geometry.sets);
    PolicyCounts counts;
    for (std::size_t i = 0; i < look_ups.size(); ++i) {
        const auto [number, asked] = look_ups[i];
        HeldLine& line = held[number];
        HeldSet& set = sets[map(addresses_[number] / geometry.line_bytes)];
        if (line.present == 0 && ++set.lines > geometry.ways) {
            for (;;) {
                const auto [when, other] = set.by_next.top();
                set.by_next.pop();
                if (held[other].present == 0 || held[other].next != when) continue;
                held[other].present = 0;
                --set.lines;
                break;
            }
        }
        const std::uint32_t missing = asked & ~line.present;
        const std::uint32_t fetched = (fill.widens() ? fill.pieces(missing) : missing) & ~line.present;
        counts.asked += static_cast<unsigned>(std::popcount(asked));
        counts.hits += static_cast<unsigned>(std::popcount(asked & ~missing));
        counts.fetched += static_cast<unsigned>(std::popcount(fetched));
        line.present |= fetched;
        line.next = next[i];
        set.by_next.emplace(line.next, number);
    }
    return counts;
}

PolicyCounts BeladyCaches::counts(const CacheGeometry& geometry) const {
    PolicyCounts all;
    for (const auto& [cache, look_ups] : look_ups_) {
        const PolicyCounts one = counts_of_cache(geometry, look_ups);
        all.asked += one.asked;
        all.hits += one.hits;
        all.fetched += one.fetched;
    }
    return all;
}

}  // namespace raycache::cachesim
