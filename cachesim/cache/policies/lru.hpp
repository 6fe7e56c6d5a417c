// Least recently used, in the representation that is fastest for the geometry and the machine. All give the same
// counts.
#pragma once

#include <memory>

#include "cachesim/cache/level.hpp"
#include "cachesim/instruction_set.hpp"

namespace raycache::cachesim {

/// Up to here an array in order of age is faster than a hash table (measured: MODEL.md, "Speed").
inline constexpr std::uint64_t lru_few_ways_limit = 64;

std::unique_ptr<Level> make_lru(const CacheGeometry&, CacheRange caches, std::uint64_t lines, InstructionSet);

}  // namespace raycache::cachesim
