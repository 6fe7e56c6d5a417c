// What `quality` and `sweep` have in common: scene, reference, repeats, GPU, and how the result is printed.
#pragma once

#include <string>
#include <vector>

#include "tools/jobs/quality_job.hpp"
#include "tools/program/gpu_options.hpp"
#include "tools/program/json_output.hpp"
#include "tools/program/options.hpp"
#include "tools/program/width_option.hpp"

namespace raycache::tools {

struct QualityOptions {
    SceneOptions scene;
    SamplingOptions sampling;
    GpuOptions gpu;  ///< at most one
    std::string baseline;
    JsonOption json;
    WidthOption width;
    bool csv = false;
    ThreadOptions threads;
    std::uint64_t reference_spp = 1024, repeats = 1;
    std::optional<float> clamp;
    std::string reference_file, reference_strategy = "random", time_resolution;

    /// `require_gpu`: --gpu must be given; else it may be.
    void add(Command&, bool require_gpu);
    /// What they ask for, without cases and baseline.
    QualityJob job() const;
    /// Checks what concerns the options of `command` alone, warns of what has no effect, and runs the job. `outputs`:
    /// what the caller is going to write. A reference that cannot be kept where it was asked for is a failed delivery.
    QualityResult measure(const Command& command, const QualityJob&, const FileNames& outputs, Deliveries&,
                          Progress&) const;
    /// Of these strategies: the one asked for, else Cranley-Patterson where it is among them.
    std::string baseline_of(const std::vector<std::string>& strategies) const;
};

}  // namespace raycache::tools
