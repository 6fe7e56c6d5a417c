// The points of a picture's pixels: how many, of how many dimensions, drawn from which seed. What sequences and
// decorrelations have in common; what a decorrelation may be given besides is its Parameters.
#pragma once

#include <cstdint>

namespace raycache::tracer {

struct SampleSet {
    std::uint64_t spp = 1;  ///< N, the points of a pixel, 1 … 2^32
    std::uint64_t seed = 0;

    // What the user does not type: SamplingStrategy and its callers fill these in.
    std::uint32_t dimensions = 0;  ///< of a point: the random numbers of a path; 0: unknown
    std::uint32_t width = 0;       ///< of the picture in pixels; 0: unknown, refused by what depends on a pixel's place
};

/// Throws UsageError unless N is 1 … 2^32.
void check_spp(std::uint64_t spp);

}  // namespace raycache::tracer
