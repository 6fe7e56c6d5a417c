// The job "capture": a scene to a trace file, to a replay package for GPUs, or to both.
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
    std::string output;       ///< the trace, or "-" for stdout; empty: none
    std::string gpu_package;  ///< folder of a replay package (docs/gpu_package.md); empty: none
};

struct CaptureResult {
    Json trace;  ///< trace_json()
    std::uint64_t warps = 0, rays = 0;
};

/// Throws UsageError for settings that make no sense and Error where an output cannot be written.
CaptureResult run(const CaptureJob&, Observer&);

}  // namespace raycache::tools
