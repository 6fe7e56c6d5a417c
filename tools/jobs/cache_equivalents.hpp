// What compare and explain say of cache sizes where they are asked to: one sentence for each strategy beside the
// baseline and each GPU.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/jobs/launches.hpp"

namespace raycache::tools {

/// Of L1, as to_sentence() has it; for several GPUs each begins with its name. Traces or reads the launches, whole
/// ones, once more and throws as the job "curve" does. `baseline`: as baseline_of() takes it; none: the first of the
/// launches.
std::vector<std::string> cache_equivalents(const LaunchSettings&, const std::vector<cachesim::Gpu>&,
                                           const std::optional<std::string>& baseline, Observer&);

}  // namespace raycache::tools
