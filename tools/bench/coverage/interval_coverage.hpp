// How often the 95 % intervals of estimates from windows hold what they estimate, and how far off their means are.
//
// Exact: all N sample indices of a small picture, launch after launch, through one replay that is never cleared;
// counted once its caches have seen a few launches. Estimates: many, each of so many blocks that are drawn anew.
// Blocks are replayed once for each of a pool of drawings of their places, and every estimate takes one of the pool for
// each of its blocks: estimates share results, but no estimate knows of another.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tools/jobs/gpu_settings.hpp"
#include "tools/jobs/sampling_settings.hpp"
#include "tools/jobs/scene_settings.hpp"
#include "tools/jobs/windows/window_plan.hpp"

namespace raycache::bench {

struct CoverageSettings {
    tools::SceneSettings scene;
    tools::SamplingSettings sampling;
    tools::GpuSettings gpu;
    std::uint64_t spp = 64;    ///< N
    tools::WindowSizes sizes;  ///< of one block
    std::uint32_t blocks = 8;  ///< of one estimate
    std::uint32_t estimates = 200;
    std::uint32_t pool = 16;  ///< drawings of the places of each block
    bool timed = false;
};

/// One figure's estimates against its exact value.
struct FigureCoverage {
    std::string figure;
    double exact = 0;
    double held = 0;        ///< share of the estimates whose interval holds it
    double half_width = 0;  ///< of the interval over the exact value, on average
    double error = 0;       ///< the same of the estimates, root of the mean square
    double bias = 0;        ///< the same of the mean of all estimates, with its sign
};

/// Cranley-Patterson, micro-jitter and their ratio. Throws as the job "replay" does.
std::vector<FigureCoverage> interval_coverage(const CoverageSettings&, tools::Observer&);

}  // namespace raycache::bench
