// Two sources of launches -> an explanation: every launch of both through the same GPU, with a listener that sorts
// misses and charges pixels.
#pragma once

#include <array>

#include "cachesim/analysis/pixel_costs.hpp"
#include "cachesim/gpus/gpu.hpp"
#include "cachesim/report/explanation.hpp"
#include "tools/jobs/explained_pair.hpp"
#include "tools/jobs/launch_source.hpp"
#include "tools/jobs/observer.hpp"

namespace raycache::tools {

struct ExplainRequest {
    std::array<const LaunchSource*, 2> sources;  ///< base, other
    ExplainedPair pair;                          ///< the same
    cachesim::Gpu gpu;
    cachesim::GroupBy by = cachesim::GroupBy::none;
    bool timed = true;    ///< whether predicted times are wanted, if the GPU has a [timing]
    bool pixels = false;  ///< whether costs of pixels are wanted
};

struct Explained {
    cachesim::Explanation explanation;
    std::array<cachesim::PixelCosts, 2> costs;  ///< of all launches; empty if not wanted
};

/// Throws Error as begin_explanation() does. The result does not depend on the
/// number of threads.
Explained explain(const ExplainRequest&, Observer&);

}  // namespace raycache::tools
