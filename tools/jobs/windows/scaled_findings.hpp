// What became of the look-ups of windows, scaled to the launch that their block tells of.
#pragma once

#include "cachesim/analysis/findings.hpp"
#include "cachesim/replay/statistics.hpp"

namespace raycache::tools {

/// Look-ups and misses of every level, ray type, bounce and kind of object become those of `launch`; the classes of the
/// misses keep their shares. So does what has no part in `launch`: depths of the BVH, and the fetchers of L1 hits.
cachesim::Findings scaled_findings(const cachesim::Findings& of_windows, const cachesim::LaunchStatistics& launch);

}  // namespace raycache::tools
