// Least recently used, in the representation that is fastest for the geometry and the machine. All give the same
// counts.
#pragma once

#include <memory>

#include "cachesim/cache/level.hpp"
#include "cachesim/instruction_set.hpp"

namespace raycache::cachesim {

std::unique_ptr<Level> make_lru(const CacheGeometry&, CacheRange caches, std::uint64_t lines, InstructionSet);

}  // namespace raycache::cachesim
