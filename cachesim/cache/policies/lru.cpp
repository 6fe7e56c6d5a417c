#include "cachesim/cache/policies/lru.hpp"

#include "cachesim/cache/policies/lru_avx512.hpp"
#include "cachesim/cache/policies/lru_few_ways.hpp"
#include "cachesim/cache/policies/lru_many_ways.hpp"
#include "cachesim/cache/policies/lru_many_ways_avx512.hpp"

namespace raycache::cachesim {

std::unique_ptr<Level> make_lru(const CacheGeometry& geometry, CacheRange caches, std::uint64_t lines,
                                InstructionSet instructions) {
    const bool avx512 = instructions >= InstructionSet::avx512;
    if (geometry.ways <= lru_few_ways_limit && LruFewWays::fits(lines, geometry.line_bytes / geometry.sector_bytes)) {
        if (avx512) return make_lru_avx512(geometry, caches.count);
        return std::make_unique<LevelWith<LruFewWays>>(geometry, caches);
    }
    if (avx512 && fits_lru_many_ways_avx512(geometry)) return make_lru_many_ways_avx512(geometry, caches.count);
    if (geometry.ways < 0xffff) return std::make_unique<LevelWith<LruManyWays<std::uint16_t>>>(geometry, caches);
    return std::make_unique<LevelWith<LruManyWays<std::uint32_t>>>(geometry, caches);
}

}  // namespace raycache::cachesim
