// One level of sectored set-associative caches of equal geometry: all L1s of the GPU, or its one L2.
//
// A look-up of a line that is absent evicts a line and fetches the wanted sectors only; a look-up of a line that is
// present but lacks wanted sectors (a sector miss) fetches just these. What is fetched is there for the next look-up.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "cachesim/cache/request.hpp"
#include "cachesim/cache/set_index.hpp"
#include "cachesim/gpus/gpu.hpp"

namespace raycache::cachesim {

/// Looks up batches, so that the call through the table of the policy costs nothing per look-up.
class Level {
public:
    virtual ~Level() = default;

    /// Looks up the requests in order. Writes those that lack sectors, with only the missing sectors, to `misses`
    /// (same order; may be the input's own memory) and returns their number.
    virtual std::size_t process(std::span<const Request> requests, Request* misses) = 0;
};

/// `Policy` holds tags and sectors of all sets and decides what to evict. It offers
///     Policy(sets, ways, sectors_per_line)                all sets empty
///     std::uint32_t access(set, const Request&)           the sectors that were missing; now present
///     void prefetch(set, const Request&) const            a hint, changes nothing
template <class Policy>
class LevelWith final : public Level {
public:
    LevelWith(const CacheGeometry& geometry, unsigned caches)
        : index_(geometry.sets, geometry.index),
          sets_per_cache_(caches > 1 ? geometry.sets : 0),
          policy_(geometry.sets * caches, geometry.ways, geometry.line_bytes / geometry.sector_bytes) {}

    std::size_t process(std::span<const Request> requests, Request* misses) override {
        std::array<std::uint64_t, 64> sets;  // a run of look-ups ahead, so that their memory is on its way
        std::size_t written = 0;
        while (!requests.empty()) {
            const auto run = requests.first(std::min(requests.size(), sets.size()));
            for (std::size_t i = 0; i < run.size(); ++i) {
                sets[i] = run[i].cache * sets_per_cache_ + index_(run[i].line);
                policy_.prefetch(sets[i], run[i]);
            }
            for (std::size_t i = 0; i < run.size(); ++i) {
                const std::uint32_t missing = policy_.access(sets[i], run[i]);
                misses[written] = run[i];
                misses[written].sectors = missing;
                written += missing != 0;
            }
            requests = requests.subspan(run.size());
        }
        return written;
    }

private:
    SetIndexer index_;
    std::uint64_t sets_per_cache_;  ///< 0 for a shared level
    Policy policy_;
};

}  // namespace raycache::cachesim
