// How many of a warp's lanes differ.
#pragma once

#include <cstdint>

#include "cachesim/instruction_set.hpp"

namespace raycache::cachesim {

using CountDistinct = unsigned(const std::uint32_t* elements, unsigned count);

/// For up to 32 elements.
CountDistinct* count_distinct(InstructionSet);

/// The same for any number, without vectors: fastest for few, and where vectors are short.
unsigned distinct_by_bits(const std::uint32_t* elements, unsigned count);

}  // namespace raycache::cachesim
