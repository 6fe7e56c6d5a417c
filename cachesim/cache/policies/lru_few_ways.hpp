// Least recently used, for few ways, in vectors: a set is an array of its lines in order of last use, newest first. A
// look-up compares all ways at once and moves the line to the front without a branch that depends on what it finds.
// Tag and sectors share a 32-bit word.
#pragma once

#include <cstdint>
#include <memory>

#include "cachesim/cache/level.hpp"
#include "cachesim/instruction_set.hpp"

namespace raycache::cachesim {

/// Whether it takes caches of this geometry and lines below `lines`, and is the fastest for them.
bool suits_lru_few_ways(const CacheGeometry&, std::uint64_t lines, InstructionSet);

/// Only for what it suits.
std::unique_ptr<Level> make_lru_few_ways(const CacheGeometry&, unsigned caches, InstructionSet);

}  // namespace raycache::cachesim
