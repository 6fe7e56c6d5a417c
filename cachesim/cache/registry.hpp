// The replacement policies by name. A new policy is one file in policies/ and one line in registry.cpp.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "cachesim/cache/level.hpp"

namespace raycache::cachesim {

/// `caches` empty caches of this geometry. `lines`: every request's line id is below this (LineIds::count()).
/// Throws Error if the policy is unknown. The geometry must have passed find_problem().
std::unique_ptr<Level> make_level(const CacheGeometry&, unsigned caches, std::uint64_t lines);

/// Names that CacheGeometry::policy may have, sorted.
std::vector<std::string> cache_policies();

}  // namespace raycache::cachesim
