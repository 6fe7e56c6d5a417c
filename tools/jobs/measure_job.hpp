// The job "measure": how long Embree takes on this processor for the rays of several strategies. The rays, and so their
// numbers, depend on nothing but the settings; times are those of the machine, and differ from run to run.
//
// Of each sample index the rays of all strategies are logged (tracer/simt/ray_log.hpp) and then walked on one thread:
// once to warm up, when every end of a ray is checked against the tracer's own, then `repeats` times, in an order of
// strategies, modes and groups that is shuffled anew for each repetition. The median of the thread's processor time
// stands for the index. Speed-ups are of paired indices (cachesim/analysis/estimate.hpp).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tools/jobs/machine.hpp"
#include "tools/jobs/sampling_settings.hpp"
#include "tools/jobs/subject.hpp"
#include "tracer/bvh/embree_walker.hpp"

namespace raycache::tools {

/// Which rays have a row of their own, beside the row of all.
enum class RayGroups { none, ray, bounce, both };

struct MeasureJob {
    SceneSettings scene;
    SamplingSettings sampling;
    std::vector<CaseSettings> cases;             ///< megakernels
    std::string baseline = "cranley-patterson";  ///< the strategy that speed-ups refer to, one of the cases
    std::vector<std::string> modes;  ///< names of tracer::walk_modes(); none: single, and the widest packets
    bool shuffled = true;            ///< also the same rays in shuffled order
    RayGroups by = RayGroups::none;
    std::uint32_t repeats = 3;

    /// Throws UsageError for an unknown mode, a baseline that is no case, no case, no repetition, and as
    /// capture_settings() does.
    void check() const;
};

/// The walks of one strategy's rays in one mode, order and group.
struct MeasuredWalk {
    std::string strategy, sequence, parameters, thread_map;
    std::uint64_t spp = 0, seed = 0;
    bool control = false;  ///< the baseline with another seed
    std::string mode, order, group;
    std::vector<double> rays, seconds;          ///< of each sample index
    std::vector<std::vector<double>> counters;  ///< by counter, of each sample index; NaN: not counted
    std::uint64_t other_ends = 0;               ///< rays that ended elsewhere than in the tracer's own walk
};

struct MeasureResult {
    Machine machine;
    tracer::EmbreeFacts embree;
    std::vector<std::string> counters;  ///< names of hardware counters; often none
    std::string scene, baseline;
    std::uint32_t repeats = 0;
    std::vector<MeasuredWalk> walks;  ///< of each N: by group, order, mode, and strategy
    Subject subject;
};

/// Throws as check() does, Error for a mode that this processor lacks, UsageError for strategies whose thread maps make
/// different launches.
MeasureResult run(const MeasureJob&, Observer&, const FileNames& outputs = {});

}  // namespace raycache::tools
