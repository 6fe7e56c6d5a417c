// The job "capture": a scene to a trace file.
#pragma once

#include <cstdint>
#include <string>

#include "tools/jobs/sampling_settings.hpp"
#include "tools/jobs/subject.hpp"

namespace raycache::tools {

struct CaptureJob {
    SceneSettings scene;
    SamplingSettings sampling;
    CaseSettings strategy;
    std::string output;  ///< the trace, or "-" for stdout
};

struct CaptureResult {
    Json trace;  ///< trace_json()
    std::uint64_t warps = 0, rays = 0;
};

/// Throws UsageError for settings that make no sense and Error where the trace cannot be written.
CaptureResult run(const CaptureJob&, Observer&);

}  // namespace raycache::tools
