// When an estimate is certain enough: which of its figures must be, and how certain each is.
#pragma once

#include <string>

#include "tools/jobs/replay_launches.hpp"

namespace raycache::tools {

/// The largest half width of a 95 % interval over its mean, and whose it is.
struct Worst {
    double error = 0;  ///< infinite where a figure has no interval
    std::string of;
};

/// Bytes below this share of those asked of L1 are not waited for: nothing hangs on them, and what hardly occurs takes
/// the longest to count. They keep their intervals.
inline constexpr double negligible_share = 0.01;

/// Of ratios to the baseline where there is one, else of means: predicted times if there are any, else bytes per ray of
/// every level, where they are not negligible. `baseline`, `across_gpus`: as EstimateSettings has them.
Worst worst_error(const Predicted&, const std::string& baseline, bool across_gpus = false);

}  // namespace raycache::tools
