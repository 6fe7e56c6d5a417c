// The replacement policies by name. A new policy is one file in policies/ and one line in registry.cpp.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "cachesim/cache/level.hpp"
#include "cachesim/cache/policies/victim_order.hpp"
#include "cachesim/instruction_set.hpp"

namespace raycache::cachesim {

/// Empty caches of this geometry for lines whose numbers are below `lines`. Throws Error if the policy is
/// unknown. The geometry must have passed find_problem().
std::unique_ptr<Level> make_level(const CacheGeometry&, CacheRange caches, std::uint64_t lines,
                                  InstructionSet = best_instruction_set());

/// What a timed replay asks whom to evict from one cache, number `cache` of its level; nothing for lru.
std::unique_ptr<VictimOrder> make_victim_order(const CacheGeometry&, unsigned cache);

/// Names that CacheGeometry::policy may have, sorted.
std::vector<std::string> cache_policies();

}  // namespace raycache::cachesim
