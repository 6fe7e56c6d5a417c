// Which values of a GPU may be others than its file says, and the GPU with others.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "cachesim/gpus/gpu.hpp"

namespace raycache::cachesim {

/// KEY and VALUE, as `--set` takes them: {"timing.l2_latency", "240"}.
using ChosenValue = std::pair<std::string, std::string>;

/// The values of a file that have a range or choices with more than one value, in the order of gpu_values(). A value
/// that `changes` gives is none of them: the user has said what it is. Throws as load_gpu() does.
std::vector<GpuValue> open_values(const std::string& name_or_path, const std::vector<std::string>& changes = {});

/// load_gpu() with `changes`, and with these in place of the file's values. Other sets or slices of a cache keep its
/// capacity to the nearest way: its ways become fewer or more, unless `changes` gives them. The GPU's name and its
/// changes are those of `changes` alone. Throws as load_gpu() does, also for values that are right one by one and not
/// together.
Gpu load_with(const std::string& name_or_path, const std::vector<std::string>& changes,
              const std::vector<ChosenValue>& chosen);

}  // namespace raycache::cachesim
