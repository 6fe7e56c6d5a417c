// Least recently used, in the representation that is faster for the geometry. Both give the same counts.
#pragma once

#include <memory>

#include "cachesim/cache/level.hpp"
#include "cachesim/cache/policies/lru_few_ways.hpp"
#include "cachesim/cache/policies/lru_many_ways.hpp"
#include "cachesim/cache/policies/lru_medium_ways.hpp"

namespace raycache::cachesim {

/// Measured: MODEL.md, "Speed".
inline std::unique_ptr<Level> make_lru(const CacheGeometry& geometry, unsigned caches, std::uint64_t lines) {
    if (LruFewWays::fits(lines, geometry.line_bytes / geometry.sector_bytes)) {
        if (geometry.ways <= 20) return std::make_unique<LevelWith<LruFewWays>>(geometry, caches);
        if (geometry.ways <= 32) return std::make_unique<LevelWith<LruMediumWays<2>>>(geometry, caches);
        if (geometry.ways <= 48) return std::make_unique<LevelWith<LruMediumWays<3>>>(geometry, caches);
        if (geometry.ways <= 64) return std::make_unique<LevelWith<LruMediumWays<4>>>(geometry, caches);
    }
    return std::make_unique<LevelWith<LruManyWays>>(geometry, caches);
}

}  // namespace raycache::cachesim
