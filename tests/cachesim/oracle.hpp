// The replay as its documentation says it, written for obviousness: lists and maps, everything in memory.
#pragma once

#include <cstdint>
#include <vector>

#include "cachesim/gpus/gpu.hpp"
#include "cachesim/instruction_set.hpp"
#include "cachesim/replay/statistics.hpp"
#include "reference_trace.hpp"

namespace raycache::cachesim::test {

/// The documented set of a line, by 128-bit-free textbook arithmetic.
std::uint64_t naive_set(const CacheGeometry&, std::uint64_t line);

LaunchStatistics naive_replay(const Gpu&, const Launch&, std::uint32_t sample = 0);

/// The same launch through Replay.
LaunchStatistics replay(const Gpu&, const Launch&, std::uint32_t sample = 0, InstructionSet = best_instruction_set());

}  // namespace raycache::cachesim::test
