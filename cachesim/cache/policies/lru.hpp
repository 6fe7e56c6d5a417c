// Least recently used, in the representation that is faster for the geometry. Both give the same counts.
#pragma once

#include <memory>

#include "cachesim/cache/level.hpp"
#include "cachesim/cache/policies/lru_few_ways.hpp"
#include "cachesim/cache/policies/lru_many_ways.hpp"

namespace raycache::cachesim {

/// Up to here an array in order of age is faster than a hash table (measured: MODEL.md, "Speed").
inline constexpr std::uint64_t lru_few_ways_limit = 64;

inline std::unique_ptr<Level> make_lru(const CacheGeometry& geometry, unsigned caches, std::uint64_t lines) {
    if (geometry.ways <= lru_few_ways_limit && LruFewWays::fits(lines, geometry.line_bytes / geometry.sector_bytes))
        return std::make_unique<LevelWith<LruFewWays>>(geometry, caches);
    return std::make_unique<LevelWith<LruManyWays>>(geometry, caches);
}

}  // namespace raycache::cachesim
