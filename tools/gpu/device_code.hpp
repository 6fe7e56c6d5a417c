// What the code of the walk needs to be compiled both for a GPU (nvcc) and for the processor here: bits, 16-byte loads
// through the read-only path, minima and maxima that ignore a NaN in their first operand.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

#if defined(__CUDACC__)
#define RAYCACHE_BOTH __host__ __device__ inline
#else
#define RAYCACHE_BOTH inline
#endif

namespace raycache::gpu {

/// 16 bytes as one load brings them.
struct alignas(16) Words {
    std::uint32_t x, y, z, w;
};

/// On a GPU LDG.128 through the read-only path. `address`: a multiple of 16.
RAYCACHE_BOTH Words load16(const void* address) {
#if defined(__CUDA_ARCH__)
    const uint4 v = __ldg(static_cast<const uint4*>(address));
    return {v.x, v.y, v.z, v.w};
#else
    Words v;
    std::memcpy(&v, address, sizeof v);
    return v;
#endif
}

RAYCACHE_BOTH float as_float(std::uint32_t bits) {
#if defined(__CUDA_ARCH__)
    return __uint_as_float(bits);
#else
    float value;
    std::memcpy(&value, &bits, sizeof value);
    return value;
#endif
}

RAYCACHE_BOTH std::uint32_t as_bits(float value) {
#if defined(__CUDA_ARCH__)
    return __float_as_uint(value);
#else
    std::uint32_t bits;
    std::memcpy(&bits, &value, sizeof bits);
    return bits;
#endif
}

/// The larger; `b` where `a` is a NaN.
RAYCACHE_BOTH float larger(float a, float b) {
#if defined(__CUDA_ARCH__)
    return fmaxf(a, b);
#else
    return a > b ? a : b;
#endif
}

/// The smaller; `b` where `a` is a NaN.
RAYCACHE_BOTH float smaller(float a, float b) {
#if defined(__CUDA_ARCH__)
    return fminf(a, b);
#else
    return a < b ? a : b;
#endif
}

RAYCACHE_BOTH float size_of(float value) { return as_float(as_bits(value) & 0x7fffffffU); }

/// Bits that are set.
RAYCACHE_BOTH std::uint32_t count_bits(std::uint32_t bits) {
#if defined(__CUDA_ARCH__)
    return static_cast<std::uint32_t>(__popc(bits));
#else
    return static_cast<std::uint32_t>(__builtin_popcount(bits));
#endif
}

/// Place of the lowest and of the highest bit that is set; one must be.
RAYCACHE_BOTH std::uint32_t lowest_bit(std::uint32_t bits) {
#if defined(__CUDA_ARCH__)
    return static_cast<std::uint32_t>(__ffs(bits) - 1);
#else
    return static_cast<std::uint32_t>(__builtin_ctz(bits));
#endif
}
RAYCACHE_BOTH std::uint32_t highest_bit(std::uint32_t bits) {
#if defined(__CUDA_ARCH__)
    return static_cast<std::uint32_t>(31 - __clz(static_cast<int>(bits)));
#else
    return static_cast<std::uint32_t>(31 - __builtin_clz(bits));
#endif
}

}  // namespace raycache::gpu
