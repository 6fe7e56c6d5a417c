// The automatic scrambling distance of Blender Cycles, by Blender's own names. Source: Cycles, blender/sync.cpp
// (distance) and scene/integrator.cpp (minimum samples), read in November 2026:
//     distance = multiplier * 4 / sqrt(samples)
//     samples  = N, with adaptive sampling the lesser of N and the minimum samples
//     minimum samples, where they are left at 0 (automatic) = max(4, ceil(16 / threshold^0.3))
// A distance of 1 or more is off. Cycles reads it only where the sampling pattern is Tabulated Sobol.
#pragma once

#include <cstdint>
#include <optional>

namespace raycache::tracer {

struct CyclesSettings {
    double multiplier = 1;          ///< Scrambling Distance Multiplier, 0 or more
    std::uint64_t min_samples = 0;  ///< Min Samples of adaptive sampling; 0: automatic, from the threshold
    std::optional<double> noise_threshold = 0.01;  ///< Noise Threshold, 0 … 1; 0: automatic; none: no adaptive sampling
};

/// How many samples the distance is made for: N without adaptive sampling, else at most the minimum samples (of which
/// Cycles takes at least 4, and with a threshold of 0 those of max(0.001, 1/N)). Precondition: the settings are in
/// range.
std::uint64_t cycles_samples(const CyclesSettings&, std::uint64_t spp);

/// The distance before the clamp: 1 or more means off.
double cycles_distance(const CyclesSettings&, std::uint64_t spp);

}  // namespace raycache::tracer
