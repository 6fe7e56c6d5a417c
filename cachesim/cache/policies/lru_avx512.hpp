// LruFewWays in AVX-512: a set is one to four vectors of 16 words, in order of last use, newest first. A look-up
// compares all ways at once and moves the line to the front without a branch that depends on what it finds.
#pragma once

#include <memory>

#include "cachesim/cache/level.hpp"

namespace raycache::cachesim {

/// At most 64 ways, and lines that LruFewWays::fits(). Only for machines with InstructionSet::avx512.
std::unique_ptr<Level> make_lru_avx512(const CacheGeometry&, unsigned caches);

}  // namespace raycache::cachesim
