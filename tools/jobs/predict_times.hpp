// How long a GPU is predicted to take for the pictures of strategies.
#pragma once

#include <vector>

#include "tools/jobs/measure_quality.hpp"

namespace raycache::tools {

/// Fills QualityRow::timing for request.gpu, with speed-ups over QualityRow::baseline: of the traced launches, each
/// from cold caches, or of the steady state from windows where request.estimate asks for it.
void predict_times(const tracer::PreparedScene&, const QualityRequest&, std::vector<QualityRow>&, Observer&);

}  // namespace raycache::tools
