// The job "samples": the points that all pixels together take in two dimensions, without a scene.
#pragma once

#include <array>
#include <cstdint>

#include "tools/jobs/samples_union.hpp"
#include "tools/jobs/sampling_settings.hpp"

namespace raycache::tools {

struct SamplesJob {
    SamplingSettings sampling;
    CaseSettings strategy{{"micro-jitter"}, "halton", 128, {}, {}};
    std::array<std::uint32_t, 2> dimensions{0, 1};
    std::uint64_t copies = 150;  ///< pixels

    /// Throws UsageError for values out of range.
    tracer::StrategySettings settings() const;
};

struct SamplesResult {
    SampleUnion samples;
};

/// Throws UsageError as make_sample_union() does.
SamplesResult run(const SamplesJob&, Observer&);

}  // namespace raycache::tools
