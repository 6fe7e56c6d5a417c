// One level of sectored set-associative caches of equal geometry: all L1s of the GPU, or its one L2.
//
// A look-up of a line that is absent evicts a line and fetches the wanted sectors only; a look-up of a line that is
// present but lacks wanted sectors (a sector miss) fetches just these. Fill can add neighbours to what is fetched. What
// is fetched is there for the next look-up.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "cachesim/cache/fill.hpp"
#include "cachesim/cache/line_map.hpp"
#include "cachesim/cache/request.hpp"
#include "cachesim/frontend/line_ids.hpp"
#include "cachesim/gpus/gpu.hpp"

namespace raycache::cachesim {

/// Looks up runs of requests, so that the call through the table of the policy costs little per look-up.
class Level {
public:
    virtual ~Level() = default;

    /// Looks up the requests in order, each in the level's cache number first_cache + request.cache (in the one cache
    /// of a shared level), and leaves in it the sectors that it fetched: those that were missing and what Fill adds.
    virtual void process(std::span<Request> requests, std::uint32_t first_cache) = 0;
};

/// `Policy` holds tags and sectors of all sets and decides what to evict. It offers
///     Policy(sets, ways, sectors_per_line, …)                  all sets empty; `more` comes last
///     std::uint32_t access(set, id, sectors)                   the sectors that were missing; now present
///     void prefetch(set, id) const                             a hint, changes nothing
template <class Policy>
class LevelWith final : public Level {
public:
    template <class... More>
    LevelWith(const CacheGeometry& geometry, unsigned caches, const LineIds& ids, More... more)
        : ids_(ids),
          map_(geometry),
          fill_(geometry),
          sets_per_cache_(caches > 1 ? geometry.slices * geometry.sets : 0),
          policy_(geometry.slices * geometry.sets * caches, geometry.ways, geometry.line_bytes / geometry.sector_bytes,
                  more...) {}

    void process(std::span<Request> requests, std::uint32_t first_cache) override {
        std::array<std::uint64_t, 64> sets;  // a run of look-ups ahead, so that their memory is on its way
        while (!requests.empty()) {
            const auto run = requests.first(std::min(requests.size(), sets.size()));
            for (std::size_t i = 0; i < run.size(); ++i) {
                sets[i] = (first_cache + run[i].cache) * sets_per_cache_ + map_(run[i].line);
                policy_.prefetch(sets[i], run[i].line - ids_.offset(run[i].region));
            }
            for (std::size_t i = 0; i < run.size(); ++i) {
                const std::uint64_t id = run[i].line - ids_.offset(run[i].region);
                run[i].sectors = policy_.access(sets[i], id, run[i].sectors);
                // Looked up again, the line is the newest already: nothing but its sectors changes.
                if (fill_.widens() && run[i].sectors)
                    run[i].sectors |= policy_.access(sets[i], id, fill_.pieces(run[i].sectors));
            }
            requests = requests.subspan(run.size());
        }
    }

private:
    LineIds ids_;
    LineMap map_;
    Fill fill_;
    std::uint64_t sets_per_cache_;  ///< 0 for a shared level
    Policy policy_;
};

}  // namespace raycache::cachesim
