// LruManyWays in AVX-512. A cache is a hash table whose buckets are vectors of 16 tags, so that one comparison finds a
// line; a look-up notes the time in the line's entry, and nothing else. Only now and then, for many evictions at once,
// the lines that have not been used for the longest time are put into a queue, oldest first.
#pragma once

#include <memory>

#include "cachesim/cache/level.hpp"

namespace raycache::cachesim {

/// Whether a geometry is fit for it.
bool fits_lru_many_ways_avx512(const CacheGeometry&);

/// Only for machines with InstructionSet::avx512.
std::unique_ptr<Level> make_lru_many_ways_avx512(const CacheGeometry&, unsigned caches);

}  // namespace raycache::cachesim
