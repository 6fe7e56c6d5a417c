#include "tools/jobs/windows/steady_replay.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <memory>
#include <numeric>
#include <utility>

#include "cachesim/replay/replay.hpp"
#include "cachesim/replay/timed/timed_replay.hpp"
#include "tools/jobs/costs.hpp"
#include "tools/jobs/launch_source.hpp"
#include "tools/jobs/windows/launch_extent.hpp"
#include "tools/jobs/windows/window_replay.hpp"
#include "traces/error.hpp"

namespace raycache::tools {
namespace {

constexpr const char* stage_of_all_samples = "all samples";
constexpr std::uint32_t warm_up_launches = 6, warm_up_waves = 9, counted_waves = 4;

/// Launches before anything is counted.
std::uint32_t warm_up(const LaunchExtent& of, std::uint32_t wave) {
    return std::max(warm_up_launches, (warm_up_waves * wave + of.warps - 1) / of.warps);
}

/// How often all N sample indices are counted: a picture of few warps would never fill the GPU.
std::uint32_t rounds_of(const LaunchExtent& of, std::uint32_t wave) {
    const std::uint64_t warps = std::uint64_t{of.launches} * of.warps;
    return static_cast<std::uint32_t>(
        std::max<std::uint64_t>({1, of.rounds, (std::uint64_t{counted_waves} * wave + warps - 1) / warps}));
}

/// Warps that a replay takes in all.
double all_warps(const LaunchExtent& of, std::uint32_t wave) {
    return (static_cast<double>(rounds_of(of, wave)) * of.launches + warm_up(of, wave)) * of.warps + wave;
}

struct SteadyCounts {
    cachesim::LaunchStatistics counted;
    cachesim::TimedStatistics time;
};

SteadyCounts replay_all(const tracer::Capture& capture, const cachesim::Gpu& gpu, const LaunchExtent& extent,
                        const Stage& stage) {
    const auto& regions = capture.header().regions;
    cachesim::Replay counted(gpu, regions, 0);
    cachesim::TimedReplay timed(gpu, regions, 0);
    const auto worker = capture.make_worker();
    const auto push = [&](std::uint32_t launch, std::uint32_t warps) {
        for (std::uint32_t warp = 0; warp < warps; ++warp) {
            traces::WarpTrace trace;
            capture.trace_warp(*worker, launch, warp, trace);
            stage.add(1, count_rays(trace));
            const auto shared = std::make_shared<const traces::WarpTrace>(std::move(trace));
            counted.push(shared);
            timed.push(shared);
        }
    };
    walk_steady(extent, wave_warps(gpu),
                {push,
                 [&] {
                     counted.count_from_here();
                     timed.count_from_here();
                 },
                 [&] {
                     counted.count_until_here();
                     timed.count_until_here();
                 }});
    SteadyCounts all{counted.finish(), timed.finish()};
    if (all.time.cycles == 0)
        throw Error(fmt::format(
            "{}: all of the picture began and ended at once, since most of its warps have no ray; expected a picture "
            "whose warps fill the GPU: raise --resolution",
            gpu.name));
    return all;
}

}  // namespace

void walk_steady(const LaunchExtent& extent, std::uint32_t wave, const SteadyWalk& walk) {
    const std::uint32_t before = warm_up(extent, wave);
    walk.count_until_here();
    for (std::uint32_t i = 0; i < before; ++i)  // the last ones, round and round
        walk.push((extent.launches - before % extent.launches + i) % extent.launches, extent.warps);
    walk.count_from_here();
    for (std::uint32_t round = 0; round < rounds_of(extent, wave); ++round)
        for (std::uint32_t i = 0; i < extent.launches; ++i) walk.push(i, extent.warps);
    walk.count_until_here();
    for (std::uint32_t left = wave, i = 0; left > 0; i = (i + 1) % extent.launches) {
        const std::uint32_t warps = std::min(left, extent.warps);
        walk.push(i, warps);
        left -= warps;
    }
}

double steady_cost(const std::vector<WindowedStrategy>& strategies, const std::vector<cachesim::Gpu>& gpus) {
    double seconds = 0;
    for (const WindowedStrategy& strategy : strategies)
        for (const cachesim::Gpu& gpu : gpus) {
            const double paths = traces::warp_lanes * all_warps(extent_of(strategy.capture), wave_warps(gpu));
            seconds += window_cost(strategy.capture.paths.bounces, paths, paths, paths);
        }
    return seconds;
}

void expect_steady(const std::vector<WindowedStrategy>& strategies, const std::vector<cachesim::Gpu>& gpus,
                   Observer& observer) {
    observer.expect(stage_of_all_samples, Work::timed_replay, steady_cost(strategies, gpus));
}

SteadyState replay_steady(const tracer::PreparedScene& scene, const std::vector<WindowedStrategy>& strategies,
                          const std::vector<cachesim::Gpu>& gpus, Observer& observer) {
    std::vector<std::unique_ptr<tracer::Capture>> captures;
    std::vector<LaunchExtent> extents;
    double warps = 0;
    for (const WindowedStrategy& strategy : strategies) {
        const LaunchExtent& extent = extents.emplace_back(extent_of(strategy.capture));
        tracer::CaptureSettings settings = strategy.capture;
        for (std::uint32_t i = 0; i < extent.launches; ++i) settings.first_indices.push_back(i * extent.indices);
        captures.push_back(std::make_unique<tracer::Capture>(scene.in_layout(strategy.layout), settings));
        for (const cachesim::Gpu& gpu : gpus) warps += all_warps(extent, wave_warps(gpu));
    }
    const std::vector<LaunchSource> sources = sources_of(captures);
    std::vector<SteadyCounts> counts(captures.size() * gpus.size());
    const Stage stage(observer, stage_of_all_samples, static_cast<std::uint64_t>(warps), "rays");
    tbb::parallel_for(
        std::size_t{0}, counts.size(),
        [&](std::size_t task) {
            const cachesim::Gpu& gpu = gpus[task % gpus.size()];
            const std::size_t s = task / gpus.size();
            LaunchExtent extent = extents[s];  // all strategies as many rounds: a map may leave more lanes idle
            for (const LaunchExtent& other : extents)
                extent.rounds = std::max(extent.rounds, rounds_of(other, wave_warps(gpu)));
            counts[task] = replay_all(*captures[s], gpu, extent, stage);
        },
        tbb::simple_partitioner());

    SteadyState steady;
    for (const auto& capture : captures) steady.traces.push_back(trace_json(capture->header(), ""));
    Predicted& all = steady.result;
    for (std::size_t task = 0; task < counts.size(); ++task) {
        const std::size_t s = task / gpus.size();
        const cachesim::Gpu& gpu = gpus[task % gpus.size()];
        LaunchSource source = sources[s];
        source.strategy.take_from(strategies[s].given);
        cachesim::Series& counted = all.traffic.emplace_back(cachesim::Series{origin_of(source, gpu), {}});
        cachesim::WindowSample& windows = counted.windows.emplace();
        windows.blocks = 1;
        windows.indices = extents[s].launches * extents[s].indices;
        windows.all_indices = true;
        counted.launches.push_back(std::move(counts[task].counted));
        cachesim::TimedSeries& timed = all.times.emplace_back();
        static_cast<cachesim::Origin&>(timed) = counted;
        timed.no_time = cachesim::no_time_note(gpu);
        timed.traversal = cachesim::traversal_name(gpu);
        timed.launches.push_back(counts[task].time);
    }
    return steady;
}

}  // namespace raycache::tools
