// A blue-noise mask: the numbers 0 … 4095 on a torus of 64x64 pixels, so placed that for every threshold the pixels
// below it lie as evenly as they can. Void and cluster: R. A. Ulichney, "The void-and-cluster method for dither array
// generation", Proc. SPIE 1913, 1993, with his Gaussian of sigma 1.5, on whole numbers, so that every machine makes the
// same mask.
#pragma once

#include <array>
#include <cstdint>

namespace raycache::tracer {

inline constexpr std::uint32_t mask_side = 64, mask_bits = 12;  ///< side^2 = 2^bits

/// Rank of each pixel, row by row: each of 0 … 4095 once. A tenth of a second.
using BlueNoiseMask = std::array<std::uint16_t, std::size_t{mask_side} * mask_side>;
BlueNoiseMask make_blue_noise_mask(std::uint64_t seed);

}  // namespace raycache::tracer
