#include "cachesim/cache/policies/lru.hpp"

#include "cachesim/cache/policies/lru_buckets.hpp"
#include "cachesim/cache/policies/lru_few_ways.hpp"
#include "cachesim/cache/policies/lru_many_ways.hpp"

namespace raycache::cachesim {

std::unique_ptr<Level> make_lru(const CacheGeometry& geometry, CacheRange caches, std::uint64_t lines,
                                InstructionSet instructions) {
    if (suits_lru_few_ways(geometry, lines, instructions))
        return make_lru_few_ways(geometry, caches.count, instructions);
    if (suits_lru_buckets(geometry, instructions)) return make_lru_buckets(geometry, caches.count, instructions);
    if (geometry.ways < 0xffff) return std::make_unique<LevelWith<LruManyWays<std::uint16_t>>>(geometry, caches);
    return std::make_unique<LevelWith<LruManyWays<std::uint32_t>>>(geometry, caches);
}

}  // namespace raycache::cachesim
