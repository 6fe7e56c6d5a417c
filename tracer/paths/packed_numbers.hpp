// Numbers as buffers of a picture hold them, and what is left of them when they are read.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "tracer/vec.hpp"

namespace raycache::tracer {

/// The nearest number of IEEE 754 binary16, ties to even, of x in [0, 65504]. Below 2^-14 they lie 2^-24 apart.
inline float rounded_to_half(float x) {
    if (x < 0x1p-14F) return std::nearbyint(x * 0x1p24F) * 0x1p-24F;
    std::uint32_t bits = std::bit_cast<std::uint32_t>(x);
    bits += 0xfffU + ((bits >> 13U) & 1U);
    return std::bit_cast<float>(bits & ~0x1fffU);
}

/// A unit vector in 2 x 16 bits: the octahedron |x| + |y| + |z| = 1 folded onto a square (Z. Cigolle et al., "A survey
/// of efficient representations for independent unit vectors", JCGT 2014).
inline std::uint32_t pack_unit(Vec3 v) {
    const float sum = std::fabs(v.x) + std::fabs(v.y) + std::fabs(v.z);
    float x = v.x / sum, y = v.y / sum;
    if (v.z < 0) {
        const float folded = std::copysign(1 - std::fabs(y), x);
        y = std::copysign(1 - std::fabs(x), y);
        x = folded;
    }
    const auto stored = [](float number) {
        return static_cast<std::uint32_t>(static_cast<std::uint16_t>(
            static_cast<std::int16_t>(std::nearbyint(std::clamp(number, -1.0F, 1.0F) * 32767))));
    };
    return stored(x) | stored(y) << 16U;
}

/// Of length 1, within 5e-5 of what was packed on each axis.
inline Vec3 unpack_unit(std::uint32_t packed) {
    const auto read = [](std::uint32_t bits) {
        return static_cast<float>(static_cast<std::int16_t>(static_cast<std::uint16_t>(bits))) / 32767;
    };
    const float x = read(packed), y = read(packed >> 16U), z = 1 - std::fabs(x) - std::fabs(y);
    if (z >= 0) return normalize({x, y, z});
    return normalize({std::copysign(1 - std::fabs(y), x), std::copysign(1 - std::fabs(x), y), z});
}

}  // namespace raycache::tracer
