// From an InstructionSet to the function that Highway compiled for it. Included by .cpp files only.
#pragma once

#include "cachesim/vector_targets.hpp"

// After the choice of targets.
#include <hwy/highway.h>

#include <cstddef>
#include <cstdint>

#include "cachesim/instruction_set.hpp"

namespace raycache::cachesim {

/// HWY_AVX2; 0 for InstructionSet::scalar.
std::int64_t highway_target(InstructionSet);

/// Where Highway's tables have the functions of this instruction set, which must not be scalar.
inline std::size_t dispatch_index(InstructionSet instructions) {
    if constexpr ((HWY_TARGETS & (HWY_TARGETS - 1)) == 0) return 0;
    hwy::ChosenTarget chosen;
    chosen.Update(highway_target(instructions));
    return chosen.GetIndex();
}

}  // namespace raycache::cachesim

/// The function compiled for this instruction set, after HWY_EXPORT(function).
#define RAYCACHE_DISPATCH(function, instructions) \
    (*(HWY_DISPATCH_TABLE(function)[::raycache::cachesim::dispatch_index(instructions)]))
