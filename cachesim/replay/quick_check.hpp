// Whether a warp's records agree with the regions, at once and without saying what is wrong.
#pragma once

#include <vector>

#include "cachesim/instruction_set.hpp"
#include "traces/header.hpp"
#include "traces/record.hpp"

namespace raycache::cachesim {

using IsRight = bool(const traces::WarpTrace&, const std::vector<traces::Region>&);

/// Nothing for InstructionSet::scalar.
IsRight* quick_check(InstructionSet);

}  // namespace raycache::cachesim
