// Capture (traversal, shading, encoding and writing the trace) and rendering (Embree's traversal, and shading) against
// Embree's rtcIntersect1 / rtcOccluded1 alone on the same rays, in turn within one repetition, so that a machine that
// slows down slows both.
#include <benchmark/benchmark.h>
#include <tbb/task_arena.h>
#include <unistd.h>

#include <bit>
#include <cstdio>
#include <filesystem>

#include "tools/bench/workload.hpp"
#include "tracer/bvh/embree_scene.hpp"
#include "tracer/paths/embree_traversal.hpp"
#include "tracer/paths/integrators/path_integrator.hpp"

namespace raycache::bench {
namespace {

using namespace tracer;

struct LoggedRay {
    Ray ray;
    bool shadow;
};

/// Lets the integrator run over Embree and keeps the rays it asked for.
class RayLogger final : public Traversal {
public:
    RayLogger(const EmbreeScene& embree, std::vector<LoggedRay>& log) : embree_(embree), log_(log) {}

    void closest(std::uint32_t mask, traces::RayType, std::uint8_t, const Ray* rays, Hit* hits) override {
        for (; mask != 0; mask &= mask - 1) {
            const int l = std::countr_zero(mask);
            hits[l] = embree_.intersect(rays[l]);
            log_.push_back({rays[l], false});
        }
    }
    std::uint32_t occluded(std::uint32_t mask, traces::RayType, std::uint8_t, const Ray* rays) override {
        std::uint32_t blocked = 0;
        for (; mask != 0; mask &= mask - 1) {
            const int l = std::countr_zero(mask);
            blocked |= std::uint32_t{embree_.occluded(rays[l])} << l;
            log_.push_back({rays[l], true});
        }
        return blocked;
    }
    void read_texels(std::uint32_t, traces::RayType, std::uint8_t, const std::uint32_t*) override {}

private:
    const EmbreeScene& embree_;
    std::vector<LoggedRay>& log_;
};

/// Traces the first launch by `traversal`.
void trace_launch(const Capture& capture, Traversal& traversal) {
    PathIntegrator integrator({scene().scene(), capture.camera(), scene().lights(), scene().texels(),
                               capture.strategy(), capture.settings().paths, traversal});
    std::array<PathLane, traces::warp_lanes> jobs;
    std::array<Vec3, traces::warp_lanes> radiance;
    for (std::uint32_t warp = 0; warp < capture.header().warps_per_launch; ++warp)
        integrator.trace(capture.lane_jobs(0, warp, jobs), jobs, radiance);
}

std::vector<LoggedRay> rays_of(const Capture& capture, const EmbreeScene& embree) {
    std::vector<LoggedRay> log;
    RayLogger logger(embree, log);
    trace_launch(capture, logger);
    return log;
}

/// Seconds of this thread that Embree takes for the rays.
double embree_seconds(const EmbreeScene& embree, const std::vector<LoggedRay>& log) {
    const double start = thread_seconds();
    std::uint64_t found = 0;
    for (const LoggedRay& r : log) found += r.shadow ? embree.occluded(r.ray) : embree.intersect(r.ray).found();
    benchmark::DoNotOptimize(found);
    return thread_seconds() - start;
}

void count_rates(benchmark::State& state, double our_rate, double their_rate) {
    state.counters["rate_to_embree"] = our_rate / their_rate;
    state.counters["Mrays_per_s"] = our_rate / 1e6;
    state.counters["embree_Mrays_per_s"] = their_rate / 1e6;
}

void capture_against_embree(benchmark::State& state, const char* strategy) {
    static const EmbreeScene embree(scene().scene());
    const auto capture = make_capture(strategy);
    const std::vector<LoggedRay> log = rays_of(*capture, embree);
    const auto path = std::filesystem::temp_directory_path() / ("raycache_bench_" + std::to_string(getpid()) + ".rct");
    for (auto _ : state) {
        std::uint64_t rays = 0;
        double ours = 0;
        tbb::task_arena one_thread(1);
        one_thread.execute([&] {
            const double start = thread_seconds();
            write_capture(*capture, path.string(), [&](std::uint64_t, std::uint64_t done) { rays += done; });
            ours = thread_seconds() - start;
        });
        const double theirs = embree_seconds(embree, log);
        state.SetIterationTime(ours);
        count_rates(state, static_cast<double>(rays) / ours, static_cast<double>(log.size()) / theirs);
        state.counters["bytes_per_ray"] =
            static_cast<double>(std::filesystem::file_size(path)) / static_cast<double>(rays);
    }
    std::filesystem::remove(path);
}

void render_against_embree(benchmark::State& state, const char* strategy) {
    const EmbreeScene& embree = scene().embree();
    const auto capture = make_capture(strategy);
    const std::vector<LoggedRay> log = rays_of(*capture, embree);
    EmbreeTraversal traversal(embree);
    const auto rays = static_cast<double>(log.size());
    for (auto _ : state) {
        const double start = thread_seconds();
        trace_launch(*capture, traversal);
        const double ours = thread_seconds() - start;
        state.SetIterationTime(ours);
        count_rates(state, rays / ours, rays / embree_seconds(embree, log));
    }
}

BENCHMARK_CAPTURE(render_against_embree, coherent, "coherent")
    ->Iterations(1)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(render_against_embree, cranley_patterson, "cranley-patterson")
    ->Iterations(1)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(capture_against_embree, coherent, "coherent")
    ->Iterations(1)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(capture_against_embree, cranley_patterson, "cranley-patterson")
    ->Iterations(1)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace raycache::bench
