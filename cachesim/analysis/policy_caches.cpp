#include "cachesim/analysis/policy_caches.hpp"

#include <bit>

#include "cachesim/cache/line_ids.hpp"
#include "cachesim/cache/registry.hpp"

namespace raycache::cachesim {

PolicyCaches::PolicyCaches(const Gpu& gpu, const std::vector<traces::Region>& regions, std::size_t level,
                           std::span<const CacheGeometry> geometries)
    : level_(level),
      caches_(level == 0 && gpu.levels.size() > 1 ? gpu.l1_per_sm : 1),
      lines_(LineIds(regions, gpu.l1().line_bytes).bound()) {
    for (const CacheGeometry& geometry : geometries) kinds_.push_back({geometry, LineMap(geometry), {}, {}});
}

void PolicyCaches::served(std::size_t /*level*/, std::span<const ServedRequest> requests) {
    if (requests.empty()) return;
    const std::uint32_t sm = requests.front().sm;  // a call is of one SM
    const std::size_t count = requests.size();
    sets_.resize(count);
    numbers_.resize(count);
    for (std::size_t i = 0; i < count; ++i) numbers_[i] = requests[i].line;
    for (Kind& kind : kinds_) {
        if (sm >= kind.of_sm.size()) kind.of_sm.resize(sm + 1);
        std::unique_ptr<Level>& level = kind.of_sm[sm];
        if (!level) level = make_level(kind.geometry, {caches_, sm * caches_}, lines_);
        const std::uint64_t sets = kind.geometry.slices * kind.geometry.sets;
        sectors_.resize(count);
        for (std::size_t i = 0; i < count; ++i) {
            sets_[i] = static_cast<std::uint32_t>(requests[i].cache * sets +
                                                  kind.map(requests[i].address / kind.geometry.line_bytes));
            sectors_[i] = requests[i].asked;
        }
        level->process(sets_.data(), numbers_.data(), sectors_.data(), count);
        for (std::size_t i = 0; i < count; ++i) {
            kind.counts.asked += static_cast<unsigned>(std::popcount(requests[i].asked));
            kind.counts.hits += static_cast<unsigned>(std::popcount(requests[i].asked & ~sectors_[i]));
            kind.counts.fetched += static_cast<unsigned>(std::popcount(sectors_[i]));
        }
    }
}

std::vector<PolicyCounts> PolicyCaches::counts() const {
    std::vector<PolicyCounts> all;
    for (const Kind& kind : kinds_) all.push_back(kind.counts);
    return all;
}

}  // namespace raycache::cachesim
