#include "tools/jobs/memory_timing.hpp"

#include <sys/mman.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <new>
#include <numeric>
#include <random>

#include "tools/jobs/machine.hpp"
#include "traces/shuffle.hpp"

namespace raycache::tools {
namespace {

/// Short ones, many: a machine that others share is quiet for moments, and one that was idle takes a while to its full
/// clock. They go on until so many in a row were no faster than the best before by a hundredth, at most so many in all.
constexpr unsigned tries = 20, most_tries = 400;

/// Zeroed, in large pages where the system gives any, so that the TLB is no part of what is measured.
class Buffer {
public:
    explicit Buffer(std::uint64_t bytes) : bytes_(bytes) {
        constexpr std::uint64_t large_page = 1U << 21;
        const std::uint64_t rounded = (bytes + large_page - 1) / large_page * large_page;
        memory_.reset(static_cast<char*>(std::aligned_alloc(large_page, rounded)));
        if (!memory_) throw std::bad_alloc();
        madvise(memory_.get(), rounded, MADV_HUGEPAGE);
        std::memset(memory_.get(), 0, rounded);
    }
    char* data() const { return memory_.get(); }
    std::uint64_t bytes() const { return bytes_; }

private:
    struct Free {
        void operator()(char* p) const { std::free(p); }
    };
    std::unique_ptr<char, Free> memory_;
    std::uint64_t bytes_;
};

/// Processor seconds of one call.
template <class Work>
double seconds_of(const Work& work) {
    const double start = thread_seconds();
    work();
    return thread_seconds() - start;
}

/// Least of what `seconds` says, called until that no longer falls.
template <class Seconds>
double least_of(const Seconds& seconds) {
    double least = seconds();
    for (unsigned in_vain = 0, i = 1; in_vain < tries && i < most_tries; ++i) {
        const double now = seconds();
        in_vain = now < 0.99 * least ? 0 : in_vain + 1;
        least = std::min(least, now);
    }
    return least;
}

template <class Work>
double least_seconds(const Work& work) {
    return least_of([&] { return seconds_of(work); });
}

/// Reads all of it, 16 bytes at a time, which every processor can: with two loads a cycle at most 32 bytes a cycle.
using Vector = std::uint64_t __attribute__((vector_size(16)));

std::uint64_t read_all(const char* from, std::uint64_t bytes) {
    Vector sums[4]{};
    for (std::uint64_t at = 0; at + 4 * sizeof(Vector) <= bytes; at += 4 * sizeof(Vector))
        for (unsigned i = 0; i < 4; ++i) sums[i] += reinterpret_cast<const Vector*>(from + at)[i];
    const Vector sum = sums[0] + sums[1] + sums[2] + sums[3];
    return sum[0] + sum[1];
}

std::uint64_t passes_over(std::uint64_t bytes) {
    constexpr std::uint64_t read_at_least = 1U << 26;
    return std::max<std::uint64_t>(1, read_at_least / bytes);
}

/// Keeps the compiler from taking away what computes it.
template <class T>
void use(T& value) {
    asm volatile("" : "+r"(value));
}

}  // namespace

double measured_mhz() {
    constexpr std::uint64_t additions = 2'000'000;
    const double seconds = least_seconds([] {
        std::uint64_t value = 0, step = 3;
        use(step);
        for (std::uint64_t i = 0; i < additions; i += 10)
            for (unsigned j = 0; j < 10; ++j) {
                value += step;
                use(value);
            }
    });
    return static_cast<double>(additions) / seconds * 1e-6;
}

double chase_ns(std::uint64_t bytes, std::uint32_t line_bytes) {
    const Buffer buffer(bytes);
    const std::uint64_t lines = std::max<std::uint64_t>(2, bytes / line_bytes);
    std::vector<std::uint32_t> order(lines);
    std::iota(order.begin(), order.end(), 0U);
    std::mt19937_64 random(1);
    shuffle_by(order, [&](std::size_t n) { return random() % n; });
    const auto place = [&](std::uint64_t i) {
        return reinterpret_cast<void**>(buffer.data() + std::uint64_t{order[i % lines]} * line_bytes);
    };
    for (std::uint64_t i = 0; i < lines; ++i) *place(i) = place(i + 1);
    const std::uint64_t loads = std::clamp<std::uint64_t>(2 * lines, 200'000, 400'000);
    void** at = place(0);
    const auto chase = [&] {
        for (std::uint64_t i = 0; i < loads; ++i) at = static_cast<void**>(*at);
        use(at);
    };
    chase();
    return least_seconds(chase) * 1e9 / static_cast<double>(loads);
}

double stream_gb_s(std::uint64_t bytes) {
    const Buffer buffer(bytes);
    const std::uint64_t passes = passes_over(bytes);
    std::uint64_t sum = read_all(buffer.data(), bytes);
    const double seconds = least_seconds([&] {
        for (std::uint64_t i = 0; i < passes; ++i) {
            sum += read_all(buffer.data(), bytes);
            use(sum);
        }
    });
    return static_cast<double>(passes * bytes) * 1e-9 / seconds;
}

double stream_all_gb_s(std::uint64_t bytes) {
    const auto threads = static_cast<std::size_t>(tbb::this_task_arena::max_concurrency());
    std::vector<std::unique_ptr<Buffer>> buffers;
    for (std::size_t i = 0; i < threads; ++i) buffers.push_back(std::make_unique<Buffer>(bytes));
    const std::uint64_t passes = passes_over(bytes);
    const double seconds = least_of([&] {
        const auto start = std::chrono::steady_clock::now();
        tbb::parallel_for(std::size_t{0}, threads, [&](std::size_t t) {
            for (std::uint64_t pass = 0; pass < passes; ++pass) {
                std::uint64_t sum = read_all(buffers[t]->data(), bytes);
                use(sum);
            }
        });
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    });
    return static_cast<double>(threads * passes * bytes) * 1e-9 / seconds;
}

}  // namespace raycache::tools
