// Caches of every size: stack distances of what L1 and L2 are asked, many L1 organisations at once, SHARDS.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <span>
#include <vector>

#include "cachesim/analysis/lru_surface.hpp"
#include "cachesim/replay/replay.hpp"
#include "tools/bench/workload.hpp"
#include "tracer/capture.hpp"

namespace raycache::bench {
namespace {

using cachesim::ServedRequest;

struct LookUp {
    std::uint32_t line, asked;
};

/// What the RTX 3070's L1s of the first SMs and its L2 are asked, of one sample index.
class LookUps final : public cachesim::RequestSink {
public:
    LookUps() : gpu_(cachesim::load_gpu("rtx-3070")) {
        const auto capture = make_capture("cranley-patterson");
        const auto worker = capture->make_worker();
        cachesim::Replay replay(gpu_, capture->header().regions, 0);
        replay.observe(*this);
        for (std::uint32_t warp = 0; warp < capture->header().warps_per_launch; ++warp) {
            auto trace = std::make_shared<traces::WarpTrace>();
            capture->trace_warp(*worker, 0, warp, *trace);
            replay.push(std::move(trace));
        }
        replay.finish();
    }

    bool wants(std::size_t level, std::uint32_t sm) const override { return level == 1 || sm < sms; }
    void served(std::size_t level, std::span<const ServedRequest> requests) override {
        if (level == 0) {
            l1_.insert(l1_.end(), requests.begin(), requests.end());
            calls_.push_back(requests.size());
        } else {
            for (const ServedRequest& r : requests) l2_.push_back({r.line, r.asked});
        }
    }

    const cachesim::Gpu& gpu() const { return gpu_; }
    const std::vector<ServedRequest>& l1() const { return l1_; }
    const std::vector<LookUp>& l2() const { return l2_; }
    /// Calls use(requests) as the replay called served().
    template <class Use>
    void for_each_call(const Use& use) const {
        const ServedRequest* next = l1_.data();
        for (const std::size_t count : calls_) {
            use(std::span(next, count));
            next += count;
        }
    }

private:
    static constexpr std::uint32_t sms = 4;
    cachesim::Gpu gpu_;
    std::vector<ServedRequest> l1_;
    std::vector<std::size_t> calls_;
    std::vector<LookUp> l2_;
};

const LookUps& look_ups() {
    static const LookUps all;
    return all;
}

void report(benchmark::State& state, std::size_t count, double seconds) {
    state.SetIterationTime(seconds);
    state.counters["Mlook_ups_per_s"] = static_cast<double>(count) / seconds / 1e6;
}

/// Fully associative, all sizes.
template <class Each>
void distances(benchmark::State& state, const std::vector<Each>& asked) {
    for (auto _ : state) {
        const double start = thread_seconds();
        cachesim::StackDistance distances(4);
        cachesim::DistanceCounts counts;
        for (std::size_t i = 0; i < asked.size(); ++i) {
            distances.prefetch(asked[std::min(i + 16, asked.size() - 1)].line);
            distances.look_up(asked[i].line, asked[i].asked, [&](std::uint32_t distance, unsigned) {
                distance == cachesim::StackDistance::never ? counts.add_first(1) : counts.add(distance, 1);
            });
        }
        report(state, asked.size(), thread_seconds() - start);
        state.counters["lines"] = distances.lines();
        state.counters["MiB"] = static_cast<double>(distances.bytes()) / (1 << 20);
        benchmark::DoNotOptimize(counts.hits(1000));
    }
}

void stack_distance_l1(benchmark::State& state) {
    std::vector<LookUp> asked;  // of one SM
    for (const ServedRequest& r : look_ups().l1())
        if (r.sm == 0) asked.push_back({r.line, r.asked});
    distances(state, asked);
}
void stack_distance_l2(benchmark::State& state) { distances(state, look_ups().l2()); }

/// Five numbers of sets with every associativity, of which 16 count: 80 configurations.
void l1_surface(benchmark::State& state) {
    std::vector<cachesim::CacheGeometry> rows;
    for (const std::uint64_t sets : {1, 4, 16, 64, 256})
        rows.push_back(cachesim::with_sets(look_ups().gpu().l1(), sets));
    constexpr std::size_t configurations = 80;
    for (auto _ : state) {
        const double start = thread_seconds();
        cachesim::LruSurface surface(0, rows);
        look_ups().for_each_call([&](std::span<const ServedRequest> requests) { surface.served(0, requests); });
        const double seconds = thread_seconds() - start;
        report(state, surface.look_ups(), seconds);
        state.counters["Mlook_ups_of_80_per_s"] =
            static_cast<double>(configurations * surface.look_ups()) / seconds / 1e6;
        state.counters["MiB"] = static_cast<double>(surface.bytes()) / (1 << 20);
    }
}

/// The curve of L2 from a share of its lines: speed of both, and how far apart the hit rates are on average over sizes
/// of eight an octave.
void sampled_l2(benchmark::State& state, double rate) {
    const cachesim::CacheGeometry geometry = cachesim::fully_associative(look_ups().gpu().levels[1]);
    const auto& asked = look_ups().l2();
    for (auto _ : state) {
        cachesim::LruSurface exact(1, std::span(&geometry, 1)), sampled(1, std::span(&geometry, 1), rate);
        double exact_seconds = 0, seconds = 0;
        std::vector<ServedRequest> call;
        for (std::size_t begin = 0; begin < asked.size(); begin += call.size()) {
            call.resize(std::min<std::size_t>(8192, asked.size() - begin));
            for (std::size_t i = 0; i < call.size(); ++i) {
                call[i].line = asked[begin + i].line;
                call[i].address = std::uint64_t{call[i].line} * geometry.line_bytes;
                call[i].asked = asked[begin + i].asked;
            }
            const double start = thread_seconds();
            exact.served(1, call);
            const double middle = thread_seconds();
            sampled.served(1, call);
            exact_seconds += middle - start;
            seconds += thread_seconds() - middle;
        }
        report(state, asked.size(), seconds);
        const cachesim::WaysCurve truth = exact.curves()[0], estimate = sampled.curves()[0];
        double error = 0, sizes = 0;
        for (double ways = 2048; ways < static_cast<double>(truth.most_useful_ways()); ways *= std::exp2(0.125)) {
            const auto w = static_cast<std::uint64_t>(ways);
            error += std::abs(static_cast<double>(truth.hits_of(w)) - static_cast<double>(estimate.hits_of(w)));
            ++sizes;
        }
        state.counters["mean_error"] = error / sizes / static_cast<double>(truth.asked);
        state.counters["exact_Mlook_ups_per_s"] = static_cast<double>(asked.size()) / exact_seconds / 1e6;
        state.counters["lines"] = static_cast<double>(sampled.lines());
        state.counters["MiB"] = static_cast<double>(sampled.bytes()) / (1 << 20);
    }
}

BENCHMARK(stack_distance_l1)->Iterations(1)->UseManualTime()->Unit(benchmark::kMillisecond);
BENCHMARK(stack_distance_l2)->Iterations(1)->UseManualTime()->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(sampled_l2, one_in_20, 0.05)->Iterations(1)->UseManualTime()->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(sampled_l2, one_in_5, 0.2)->Iterations(1)->UseManualTime()->Unit(benchmark::kMillisecond);
BENCHMARK(l1_surface)->Iterations(1)->UseManualTime()->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace raycache::bench
