// The cheapest level that predicts the speed-ups at hand as well as is wanted, chosen by a pilot.
//
// A pilot of a few blocks is traced, counted and replayed in time, as any estimate from windows. It tells how far the
// speed-up in time is from that by work alone (cachesim/analysis/double_sampling.hpp), and how much both scatter. What
// is weighed then, each with the fewest blocks that are expected to reach the target, in seconds that are modelled
// (costs.hpp) from the sizes of blocks, not measured:
//   functional: nothing more in time, work alone of more blocks: where the two speed-ups differ by no more than the
//               target, the interval of their difference included;
//   two-phase:  work of many blocks, time of as many as its difference from work needs;
//   timed:      work and time of the same blocks;
//   exact:      all of the picture (steady_replay.hpp).
// The cheapest is run and, where it falls short, the next is planned from all that is known by then. Every answer but
// the exact one is work x (time over work), so what the pilot measured is part of it and of its interval. Looks share
// the 5 % of errors as those of Estimator do. A picture so small that all of it costs no more than a pilot has none.
#pragma once

#include <vector>

#include "cachesim/gpus/gpu.hpp"
#include "tools/jobs/windows/estimate.hpp"
#include "tools/jobs/windows/windowed_case.hpp"
#include "tracer/prepared_scene.hpp"

namespace raycache::tools {

/// Throws UsageError where a level was asked for that these GPUs and settings do not have.
void check_fidelity(const EstimateSettings&, const std::vector<cachesim::Gpu>&, bool timed);

/// Settings: target_error, baseline, across_gpus. All GPUs must have a predicted time. Throws UsageError where nothing
/// is compared. The same choice and result on every machine and for any number of threads.
Estimated estimate_at_fidelity(const tracer::PreparedScene&, const std::vector<WindowedStrategy>&,
                               const EstimateSettings&, const std::vector<cachesim::Gpu>&, Observer&,
                               const WindowSizes& = {});

}  // namespace raycache::tools
