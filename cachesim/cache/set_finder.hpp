// The sets that lines go to, for many look-ups at once.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "cachesim/cache/line_map.hpp"
#include "cachesim/cache/lookups.hpp"
#include "cachesim/frontend/line_ids.hpp"

namespace raycache::cachesim {

class SetFinder {
public:
    /// `ids` must outlive this object.
    SetFinder(const CacheGeometry& geometry, const LineIds& ids)
        : map_(geometry, ids.last_line()),
          ids_(ids),
          sets_per_cache_(static_cast<std::uint32_t>(geometry.slices * geometry.sets)),
          by_low_bits_(map_.is_low_bits() && ids.dense() && geometry.sets <= 1u << LineIds::equal_bits) {}

    /// Sets of the look-ups, numbered through all caches of the level. Of the access behind a look-up, region_of(access)
    /// and cache_of(access) say where its line lies and which cache is asked.
    template <class RegionOf, class CacheOf>
    const std::uint32_t* operator()(const Lookups& lookups, const RegionOf& region_of, const CacheOf& cache_of) {
        if (sets_.size() < lookups.count) sets_.resize(lookups.lines.size());
        const std::uint32_t* const lines = lookups.lines.data();
        const std::uint32_t* const accesses = lookups.accesses.data();
        std::uint32_t* const sets = sets_.data();
        if (by_low_bits_) {
            const std::uint32_t mask = sets_per_cache_ - 1;
            for (std::size_t i = 0; i < lookups.count; ++i)
                sets[i] = cache_of(accesses[i]) * sets_per_cache_ + (lines[i] & mask);
        } else {
            for (std::size_t i = 0; i < lookups.count; ++i) {
                const std::uint64_t line = ids_.line(lines[i], region_of(accesses[i]));
                sets[i] = cache_of(accesses[i]) * sets_per_cache_ + static_cast<std::uint32_t>(map_(line));
            }
        }
        return sets;
    }

private:
    LineMap map_;
    const LineIds& ids_;
    std::uint32_t sets_per_cache_;
    bool by_low_bits_;  ///< one slice, linear sets, and an id has the low bits of its line
    std::vector<std::uint32_t> sets_;
};

}  // namespace raycache::cachesim
