// The job "quality": how good the pictures of strategies are. raycache quality and sweep print its result.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tools/jobs/gpu_settings.hpp"
#include "tools/jobs/quality_report.hpp"
#include "tools/jobs/sampling_settings.hpp"

namespace raycache::tools {

struct QualityJob {
    SceneSettings scene;
    SamplingSettings sampling;
    std::vector<CaseSettings> cases;  ///< what is compared
    GpuSettings gpu;                  ///< whose time is predicted; none or one
    std::string baseline;             ///< strategy that ratios refer to; empty: none
    std::uint64_t reference_spp = 1024;
    std::string reference_strategy = "random";
    std::string reference_file;   ///< .exr that keeps the reference; empty: the user's cache folder
    std::uint64_t repeats = 1;    ///< pictures of each case, with seeds one after the other
    std::optional<float> clamp;   ///< radiance that no channel of a sample exceeds
    bool pairs = false;           ///< find the worst pair of dimensions
    bool equal_time = false;      ///< also at the N that takes as long as the baseline; needs a GPU
    EstimateSettings estimate;    ///< of predicted times; of speed-ups over `baseline`
    std::string time_resolution;  ///< of the picture that times are of, "1920x1080"; empty: that of the pictures

    /// What is measured, without a GPU. Throws UsageError for settings that make no sense.
    QualityRequest request() const;
};

struct QualityResult {
    QualityReport report;
    QualityPictures pictures;
};

/// `gpu`: that of job.gpu, if any. A reference that cannot be kept in its file is a failed delivery; else throws Error
/// as its parts do. `outputs` as in replay_job.hpp.
QualityResult run(const QualityJob&, const std::optional<cachesim::Gpu>& gpu, Observer&, Deliveries&,
                  const FileNames& outputs = {});
/// The same with the GPU loaded. Also throws as GpuSettings::load_one() does.
QualityResult run(const QualityJob&, Observer&, Deliveries&, const FileNames& outputs = {});

}  // namespace raycache::tools
