// Least recently used, for many ways, in vectors. A cache is a hash table whose buckets are 16 tags, one to four
// vectors, so that few comparisons find a line; a look-up notes the time in the line's entry, and nothing else. Only
// now and then, for many evictions at once, the lines that have not been used for the longest time are put into a
// queue, oldest first.
#pragma once

#include <memory>

#include "cachesim/cache/level.hpp"
#include "cachesim/instruction_set.hpp"

namespace raycache::cachesim {

/// Whether it takes caches of this geometry.
bool suits_lru_buckets(const CacheGeometry&, InstructionSet);

/// Only for what it suits.
std::unique_ptr<Level> make_lru_buckets(const CacheGeometry&, unsigned caches, InstructionSet);

}  // namespace raycache::cachesim
