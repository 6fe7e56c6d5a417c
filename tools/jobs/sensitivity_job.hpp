// The job "sensitivity": how far predicted speed-ups hang on values of GPUs that no one has measured. One sample of
// launches is traced once, and replayed in time on each GPU as its file has it, with every value that has a range at
// other values, one at a time, and with all of them at once, at the points of a Latin hypercube.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "cachesim/analysis/sensitivity.hpp"
#include "tools/jobs/launches.hpp"
#include "tools/jobs/observer.hpp"
#include "tools/jobs/sensitivity/varied_gpu.hpp"

namespace raycache::tools {

struct SensitivityJob {
    LaunchSettings launches;           ///< of a scene; two cases or more, of one set of samples
    std::vector<std::string> gpus;     ///< presets, or files
    std::vector<std::string> changes;  ///< KEY=VALUE: of all GPUs, and not varied
    std::string baseline;              ///< empty: cranley-patterson
    VariationSettings variations;

    /// Windows in time of each strategy, one in each block of sample indices, on the whole GPU as its file has it; and
    /// how many of them are replayed with other values.
    std::uint32_t windows = 16, varied_windows = 8;
    bool whole_launches = false;  ///< instead of windows: those of launches.sampling, each from cold caches

    /// Throws UsageError for settings that make no sense.
    void check() const;
};

struct SensitivityResult {
    Subject subject;
    std::vector<cachesim::Sensitivity> rows;  ///< GPUs first, then strategies without the baseline
};

/// Throws as check(), VariedGpu and Launches do, and for GPUs that cannot be replayed in time. The result does not
/// depend on the number of threads.
SensitivityResult run(const SensitivityJob&, Observer&);

}  // namespace raycache::tools
