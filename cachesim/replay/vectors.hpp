// A machine of fewer lanes than a warp runs each record as several vectors, neighbouring lanes together.
#pragma once

#include <bit>
#include <cstdint>

#include "traces/record.hpp"

namespace raycache::cachesim {

/// Of some lanes, not none, those that execute with the lowest of them. `simd_width` divides 32.
inline std::uint32_t first_vector(std::uint32_t lanes, unsigned simd_width) {
    const std::uint32_t vector = ~std::uint32_t{0} >> (traces::warp_lanes - simd_width);
    return lanes & vector << (static_cast<unsigned>(std::countr_zero(lanes)) & ~(simd_width - 1));
}

}  // namespace raycache::cachesim
