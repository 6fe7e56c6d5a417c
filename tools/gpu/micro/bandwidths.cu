// Bandwidths: of L1, of L2, and of DRAM when it is read, written and copied.
#include <algorithm>
#include <functional>

#include "tools/gpu/cuda_memory.cuh"
#include "tools/gpu/micro/parts.hpp"

namespace raycache::gpu {
namespace {

constexpr std::uint32_t block_threads = 1024;
constexpr std::uint64_t kib = 1024, mib = kib * kib;

__device__ uint4 read16(const uint4* at, bool past_l1) {
    uint4 v;
    if (past_l1)
        asm volatile("ld.global.cg.v4.u32 {%0, %1, %2, %3}, [%4];"
                     : "=r"(v.x), "=r"(v.y), "=r"(v.z), "=r"(v.w)
                     : "l"(at));
    else
        asm volatile("ld.global.ca.v4.u32 {%0, %1, %2, %3}, [%4];"
                     : "=r"(v.x), "=r"(v.y), "=r"(v.z), "=r"(v.w)
                     : "l"(at));
    return v;
}

/// Each block reads its `block_words` (of 16 B), which begin `apart` words behind those of the block before, `rounds`
/// times.
template <bool past_l1>
__global__ void read_rounds(const uint4* from, std::uint64_t block_words, std::uint64_t apart, std::uint32_t rounds,
                            std::uint32_t* sink) {
    const uint4* const own = from + blockIdx.x * apart;
    std::uint32_t sum = 0;
    for (std::uint32_t r = 0; r < rounds; ++r)
        for (std::uint64_t i = threadIdx.x; i < block_words; i += blockDim.x) {
            const uint4 v = read16(own + i, past_l1);
            sum ^= v.x ^ v.y ^ v.z ^ v.w;
        }
    if (sum == 1) *sink = sum;  // never: the buffer is zero
}

__global__ void write_all(uint4* to, std::uint64_t words) {
    const std::uint64_t step = std::uint64_t{gridDim.x} * blockDim.x;
    for (std::uint64_t i = std::uint64_t{blockIdx.x} * blockDim.x + threadIdx.x; i < words; i += step)
        to[i] = make_uint4(0, 0, 0, 0);
}
__global__ void read_all(const uint4* from, std::uint64_t words, std::uint32_t* sink) {
    const std::uint64_t step = std::uint64_t{gridDim.x} * blockDim.x;
    std::uint32_t sum = 0;
    for (std::uint64_t i = std::uint64_t{blockIdx.x} * blockDim.x + threadIdx.x; i < words; i += step) {
        const uint4 v = read16(from + i, true);
        sum ^= v.x ^ v.y ^ v.z ^ v.w;
    }
    if (sum == 1) *sink = sum;
}

/// Median seconds of a launch, of seven behind one that warms up.
double seconds_of(const std::function<void()>& launch) {
    cudaEvent_t begin, end;
    check(cudaEventCreate(&begin), "making an event");
    check(cudaEventCreate(&end), "making an event");
    std::vector<float> times;
    for (int i = 0; i < 8; ++i) {
        check(cudaEventRecord(begin), "an event");
        launch();
        check(cudaGetLastError(), "launching a bandwidth benchmark");
        check(cudaEventRecord(end), "an event");
        check(cudaEventSynchronize(end), "a bandwidth benchmark");
        float milliseconds = 0;
        check(cudaEventElapsedTime(&milliseconds, begin, end), "an event's time");
        if (i > 0) times.push_back(milliseconds);
    }
    cudaEventDestroy(begin);
    cudaEventDestroy(end);
    std::sort(times.begin(), times.end());
    return 1e-3 * times[times.size() / 2];
}

}  // namespace

std::vector<Series> measure_bandwidths(const CudaDevice& device, bool quick) {
    const auto sms = static_cast<std::uint32_t>(device.properties().multiProcessorCount);
    const std::uint64_t large = (quick ? 256 : 1024) * mib;
    const DeviceBuffer from(nullptr, large, "a buffer to read"), to(nullptr, large, "a buffer to write"),
        sink(nullptr, 4, "a result");
    check(cudaMemset(from.data(), 0, large), "clearing a buffer");
    std::vector<Series> all;

    Series l1{"bandwidth of L1",
              "footprint of an SM in bytes",
              "bytes a second, all SMs",
              "one CTA of 1024 threads an SM, each reads its own buffer over and over, 16 B a thread",
              {}};
    for (const std::uint64_t bytes : {16 * kib, 32 * kib, 64 * kib, 96 * kib}) {
        const std::uint32_t rounds = static_cast<std::uint32_t>(64 * mib / bytes);
        const double s = seconds_of([&] {
            read_rounds<false>
                <<<sms, block_threads>>>(from.as<uint4>(), bytes / 16, bytes / 16, rounds, sink.as<std::uint32_t>());
        });
        l1.points.push_back({static_cast<double>(bytes), static_cast<double>(bytes) * rounds * sms / s});
    }
    all.push_back(l1);

    Series l2{"bandwidth of L2",
              "footprint in bytes",
              "bytes a second, all SMs",
              "two CTAs of 1024 threads an SM, all read one buffer past L1, 16 B a thread",
              {}};
    for (std::uint64_t bytes = 256 * kib; bytes <= 128 * mib; bytes *= 2) {
        const std::uint64_t part = std::max<std::uint64_t>(bytes / (2 * sms) / 16, 1);
        const std::uint32_t rounds = static_cast<std::uint32_t>(std::max<std::uint64_t>(mib / (part * 16), 4));
        const double s = seconds_of([&] {
            read_rounds<true>
                <<<2 * sms, block_threads>>>(from.as<uint4>(), part, part, rounds, sink.as<std::uint32_t>());
        });
        l2.points.push_back({static_cast<double>(bytes), static_cast<double>(part * 16) * rounds * 2 * sms / s});
    }
    all.push_back(l2);

    const std::uint64_t words = large / 16;
    Series dram{"bandwidth of DRAM",
                "0 read, 1 written, 2 copied (both directions counted)",
                "bytes a second",
                "streams over a buffer that is far larger than L2, 16 B a thread; the copy is the driver's",
                {}};
    dram.points.push_back({0, static_cast<double>(large) / seconds_of([&] {
                                  read_all<<<4 * sms, 512>>>(from.as<uint4>(), words, sink.as<std::uint32_t>());
                              })});
    dram.points.push_back(
        {1, static_cast<double>(large) / seconds_of([&] { write_all<<<4 * sms, 512>>>(to.as<uint4>(), words); })});
    dram.points.push_back({2, 2 * static_cast<double>(large) / seconds_of([&] {
                                  check(cudaMemcpyAsync(to.data(), from.data(), large, cudaMemcpyDeviceToDevice),
                                        "copying");
                              })});
    all.push_back(dram);
    return all;
}

}  // namespace raycache::gpu
