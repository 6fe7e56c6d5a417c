// What one LDG.128 of a warp costs, by how many lines and sectors its lanes touch: cycles of the load unit of an SM
// that does nothing else, all of it in L1.
#include <algorithm>

#include "tools/gpu/cuda_memory.cuh"
#include "tools/gpu/micro/parts.hpp"

namespace raycache::gpu {
namespace {

constexpr std::uint32_t lanes = 32, warps = 8, loads = 256, rounds = 16;

/// Each lane loads 16 bytes `loads` times from its offset, and from 16 KiB where the offsets wrap. Cycles of the block.
__global__ void load16_often(const unsigned char* from, const std::uint32_t* offsets, std::uint32_t step,
                             unsigned long long* cycles, std::uint32_t* sink) {
    constexpr std::uint32_t wrap = 16 * 1024;
    const std::uint32_t start = offsets[threadIdx.x % lanes];
    std::uint32_t sum = 0;
    unsigned long long best = ~0ULL;
    for (std::uint32_t r = 0; r < rounds; ++r) {
        __syncthreads();
        const long long begin = clock64();
        std::uint32_t at = start;
#pragma unroll 8
        for (std::uint32_t i = 0; i < loads; ++i) {
            std::uint32_t a, b, c, d;
            asm volatile("ld.global.ca.v4.u32 {%0, %1, %2, %3}, [%4];"
                         : "=r"(a), "=r"(b), "=r"(c), "=r"(d)
                         : "l"(from + at));
            sum ^= a ^ b ^ c ^ d;
            at = (at + step) % wrap;
        }
        if (sum == 1) *sink = sum;  // never: the buffer is zero; waits for the loads
        __syncthreads();
        const auto took = static_cast<unsigned long long>(clock64() - begin);
        best = took < best ? took : best;
    }
    if (threadIdx.x == 0) *cycles = best;
}

}  // namespace

std::vector<Series> measure_requests(const CudaDevice&) {
    const DeviceBuffer from(nullptr, 64 * 1024, "a buffer to load"), cycles(nullptr, 8, "a result"),
        sink(nullptr, 4, "a result");
    check(cudaMemset(from.data(), 0, from.bytes()), "clearing a buffer");
    check(cudaFuncSetAttribute(reinterpret_cast<const void*>(&load16_often),
                               cudaFuncAttributePreferredSharedMemoryCarveout, cudaSharedmemCarveoutMaxL1),
          "asking for the largest L1");
    const auto run = [&](const std::vector<std::uint32_t>& offsets) {
        const DeviceBuffer list(offsets.data(), offsets.size() * 4, "offsets");
        load16_often<<<1, warps * lanes>>>(from.as<unsigned char>(), list.as<std::uint32_t>(), 128,
                                           cycles.as<unsigned long long>(), sink.as<std::uint32_t>());
        check(cudaGetLastError(), "launching loads");
        unsigned long long took;
        check(cudaMemcpy(&took, cycles.data(), sizeof took, cudaMemcpyDeviceToHost), "loading");
        return static_cast<double>(took) / (warps * loads);
    };
    Series lines{"cycles of an LDG.128, by lines",
                 "lines of 128 B that a warp's lanes touch",
                 "cycles of the SM for each load of a warp",
                 "8 warps, L1 holds all; each line in one sector of 32 B, which lanes share in runs",
                 {}};
    Series sectors{"cycles of an LDG.128, by sectors",
                   "sectors of 32 B that a warp's lanes touch",
                   "cycles of the SM for each load of a warp",
                   "8 warps, L1 holds all; sectors follow each other, lanes share them in runs",
                   {}};
    for (std::uint32_t n = 1; n <= lanes; n *= 2) {
        std::vector<std::uint32_t> of_lines(lanes), of_sectors(lanes);
        for (std::uint32_t l = 0; l < lanes; ++l) {
            of_lines[l] = l * n / lanes * 128;
            of_sectors[l] = l * n / lanes * 32;
        }
        lines.points.push_back({static_cast<double>(n), run(of_lines)});
        sectors.points.push_back({static_cast<double>(n), run(of_sectors)});
    }
    Series dense{"cycles of an LDG.128, dense",
                 "lanes with a 16 B word of their own, the others share the last",
                 "cycles of the SM for each load of a warp",
                 "8 warps, L1 holds all; words follow each other",
                 {}};
    for (std::uint32_t n = 1; n <= lanes; n *= 2) {
        std::vector<std::uint32_t> offsets(lanes);
        for (std::uint32_t l = 0; l < lanes; ++l) offsets[l] = std::min(l, n - 1) * 16;
        dense.points.push_back({static_cast<double>(n), run(offsets)});
    }
    return {lines, sectors, dense};
}

}  // namespace raycache::gpu
