// What every replay checks before it trusts a GPU or a trace that came from a file.
#pragma once

#include <vector>

#include "cachesim/gpus/gpu.hpp"
#include "traces/header.hpp"
#include "traces/record.hpp"

namespace raycache::cachesim {

/// The GPU. Throws Error if it breaks a rule of cachesim/gpus/limits.hpp.
const Gpu& checked(const Gpu&);

/// Likewise, and throws Error if it lacks what a timed replay needs.
const Gpu& checked_timed(const Gpu&);

/// Only what a replay reads: base, sizes, count, kind. Throws Error if a region is impossible.
std::vector<traces::Region> checked(const std::vector<traces::Region>&);

/// Throws Error if a record says what the regions do not allow, or elements are too few or too many.
void check(const traces::WarpTrace&, const std::vector<traces::Region>&);

}  // namespace raycache::cachesim
