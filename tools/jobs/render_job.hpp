// The job "render": a scene to a picture.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "tools/jobs/sampling_settings.hpp"

namespace raycache::tools {

struct RenderJob {
    SceneSettings scene;
    SamplingSettings sampling;
    CaseSettings strategy;
    std::optional<float> exposure;  ///< stops; absent: automatic_exposure()
    std::optional<float> clamp;     ///< radiance that no channel of a sample exceeds
    std::string output;             ///< .png and .jpg are tone mapped, .exr and .hdr linear

    /// What is rendered. Throws UsageError for settings that make no sense.
    tracer::CaptureSettings capture() const;
};

struct RenderResult {
    std::uint32_t width = 0, height = 0;
    float exposure = 0;  ///< stops, of a tone mapped picture
};

/// Throws as capture() does, and Error where the picture cannot be written.
RenderResult run(const RenderJob&, Observer&);

}  // namespace raycache::tools
