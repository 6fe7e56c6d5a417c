// The replay as its documentation says it, written for obviousness: lists and maps, everything in memory.
#pragma once

#include <cstdint>
#include <vector>

#include "cachesim/cache/line_fills.hpp"
#include "cachesim/gpus/gpu.hpp"
#include "cachesim/instruction_set.hpp"
#include "cachesim/replay/statistics.hpp"
#include "naive_place.hpp"
#include "reference_trace.hpp"

namespace raycache::cachesim::test {

LaunchStatistics naive_replay(const Gpu&, const Launch&, std::uint32_t sample = 0);

/// Of its last level, when the launch has ended.
LineFills naive_last_level_fills(const Gpu&, const Launch&);

/// The same launch through Replay.
LaunchStatistics replay(const Gpu&, const Launch&, std::uint32_t sample = 0, InstructionSet = best_instruction_set());

}  // namespace raycache::cachesim::test
