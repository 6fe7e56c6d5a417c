// What a replay in time reads of a GPU.
#pragma once

#include <vector>

#include "cachesim/gpus/gpu.hpp"
#include "traces/header.hpp"

namespace raycache::tools {

/// The GPU with everything that no timed replay of these regions reads set to one value: GPUs that are equal so have
/// equal replays, cycle by cycle. Names are cleared, too.
cachesim::Gpu as_replayed(cachesim::Gpu, const std::vector<traces::Region>&);

}  // namespace raycache::tools
