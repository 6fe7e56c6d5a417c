#include "cachesim/cache/policies/lru.hpp"

#include "cachesim/cache/policies/lru_avx512.hpp"
#include "cachesim/cache/policies/lru_few_ways.hpp"
#include "cachesim/cache/policies/lru_many_ways.hpp"

namespace raycache::cachesim {

std::unique_ptr<Level> make_lru(const CacheGeometry& geometry, unsigned caches, const LineIds& ids,
                                InstructionSet instructions) {
    const bool few = geometry.ways <= lru_few_ways_limit &&
                     LruFewWays::fits(ids.count(), geometry.line_bytes / geometry.sector_bytes);
    if (few && instructions >= InstructionSet::avx512) return make_lru_avx512(geometry, caches, ids);
    if (few) return std::make_unique<LevelWith<LruFewWays>>(geometry, caches, ids);
    if (ids.count() <= std::uint64_t{1} << 32 && geometry.ways < 0xffff)
        return std::make_unique<LevelWith<LruManyWays<std::uint32_t, std::uint16_t>>>(geometry, caches, ids);
    return std::make_unique<LevelWith<LruManyWays<std::uint64_t, std::uint32_t>>>(geometry, caches, ids);
}

}  // namespace raycache::cachesim
