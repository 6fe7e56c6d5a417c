// Pointer chases: one thread follows a list through memory, so that each load waits for the one before.
#pragma once

#include <algorithm>
#include <cstdint>
#include <random>
#include <vector>

#include "tools/gpu/cuda_memory.cuh"

namespace raycache::gpu {

/// By which caches a load goes.
enum class Way { l1, l2 };  ///< through both; past L1

template <Way way>
__device__ std::uint32_t load_word(const std::uint32_t* at) {
    std::uint32_t value;
    if (way == Way::l1)
        asm volatile("ld.global.ca.u32 %0, [%1];" : "=r"(value) : "l"(at) : "memory");
    else
        asm volatile("ld.global.cg.u32 %0, [%1];" : "=r"(value) : "l"(at) : "memory");
    return value;
}

struct ChaseSums {
    unsigned long long cycles, slow;  ///< of all timed steps; steps that took more than `limit`
};

/// Follows `list` from word 0: `warm` steps, then `steps` that are timed one by one. `each`: their cycles, or nullptr.
template <Way way>
__global__ void chase(const std::uint32_t* list, std::uint32_t warm, std::uint32_t steps, std::uint32_t limit,
                      ChaseSums* sums, std::uint32_t* each) {
    __shared__ volatile std::uint32_t seen;  // a store of what was loaded waits for it
    std::uint32_t at = 0;
    for (std::uint32_t i = 0; i < warm; ++i) at = load_word<way>(list + at);
    seen = at;
    unsigned long long cycles = 0, slow = 0;
    for (std::uint32_t i = 0; i < steps; ++i) {
        const long long begin = clock64();
        at = load_word<way>(list + at);
        seen = at;
        const auto took = static_cast<std::uint32_t>(clock64() - begin);
        cycles += took;
        slow += took > limit ? 1 : 0;
        if (each != nullptr) each[i] = took;
    }
    *sums = {cycles, slow};
}

/// What the timer itself adds to each step: the same without a load.
static __global__ void empty_steps(std::uint32_t steps, ChaseSums* sums) {
    __shared__ volatile std::uint32_t seen;
    unsigned long long cycles = 0;
    for (std::uint32_t i = 0; i < steps; ++i) {
        const long long begin = clock64();
        seen = i;
        cycles += static_cast<std::uint32_t>(clock64() - begin);
    }
    *sums = {cycles, 0};
}

/// A list through `places`, words of memory, in random order and back to its start; word 0 is on it.
inline std::vector<std::uint32_t> random_list(std::vector<std::uint32_t> places, std::size_t words) {
    std::mt19937 random(1);
    std::vector<std::uint32_t> list(words);
    for (std::size_t i = places.size(); i > 2; --i)  // place 0 stays first
        std::swap(places[i - 1], places[1 + random() % (i - 1)]);
    for (std::size_t i = 0; i < places.size(); ++i) list[places[i]] = places[(i + 1) % places.size()];
    return list;
}

/// Every `stride` bytes of `bytes`.
inline std::vector<std::uint32_t> strided(std::uint64_t bytes, std::uint64_t stride) {
    std::vector<std::uint32_t> places;
    for (std::uint64_t at = 0; at < bytes; at += stride) places.push_back(static_cast<std::uint32_t>(at / 4));
    return places;
}

/// Runs chases on a device, and takes the timer's own cycles off.
class Chaser {
public:
    /// `flush_bytes`: so many displace everything from L2.
    explicit Chaser(std::size_t flush_bytes)
        : sums_(nullptr, sizeof(ChaseSums), "a result"),
          each_(nullptr, most_each * 4, "cycles of steps"),
          flush_(nullptr, flush_bytes, "a buffer that flushes L2") {
        empty_steps<<<1, 1>>>(1000, sums_.as<ChaseSums>());
        overhead_ = static_cast<double>(read().cycles) / 1000;
        for (const auto kernel : {&chase<Way::l1>, &chase<Way::l2>})
            check(cudaFuncSetAttribute(reinterpret_cast<const void*>(kernel),
                                       cudaFuncAttributePreferredSharedMemoryCarveout, cudaSharedmemCarveoutMaxL1),
                  "asking for the largest L1");
    }
    static constexpr std::uint32_t most_each = 1U << 16;

    void load(const std::vector<std::uint32_t>& list) {
        list_ = DeviceBuffer(list.data(), list.size() * 4, "a list to chase");
    }
    void flush_l2() {
        check(cudaMemset(flush_.data(), 0, flush_.bytes()), "flushing L2");
        check(cudaDeviceSynchronize(), "flushing L2");
    }
    struct Result {
        double cycles, slow_share;  ///< of a step
        std::vector<double> each;   ///< if asked for; ascending, unless that is not wanted
    };
    /// `limit`: cycles, the timer's own taken off.
    Result run(Way way, std::uint32_t warm, std::uint32_t steps, double limit = 0, bool each = false,
               bool sorted = true) {
        const auto raw_limit = static_cast<std::uint32_t>(limit + overhead_);
        std::uint32_t* const list = list_.as<std::uint32_t>();
        std::uint32_t* const out = each ? each_.as<std::uint32_t>() : nullptr;
        if (way == Way::l1)
            chase<Way::l1><<<1, 1>>>(list, warm, steps, raw_limit, sums_.as<ChaseSums>(), out);
        else
            chase<Way::l2><<<1, 1>>>(list, warm, steps, raw_limit, sums_.as<ChaseSums>(), out);
        check(cudaGetLastError(), "launching a chase");
        const ChaseSums sums = read();
        Result result{static_cast<double>(sums.cycles) / steps - overhead_, static_cast<double>(sums.slow) / steps, {}};
        if (each) {
            std::vector<std::uint32_t> raw(steps);
            check(cudaMemcpy(raw.data(), each_.data(), raw.size() * 4, cudaMemcpyDeviceToHost), "copying cycles");
            for (const std::uint32_t r : raw) result.each.push_back(r - overhead_);
            if (sorted) std::sort(result.each.begin(), result.each.end());
        }
        return result;
    }

private:
    ChaseSums read() const {
        ChaseSums sums;
        check(cudaMemcpy(&sums, sums_.data(), sizeof sums, cudaMemcpyDeviceToHost), "running a chase");
        return sums;
    }
    DeviceBuffer sums_, each_, flush_, list_;
    double overhead_ = 0;
};

}  // namespace raycache::gpu
