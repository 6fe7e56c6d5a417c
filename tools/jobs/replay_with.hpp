// Replays of any kind over all launches of all sources, for several GPUs side by side over the same warps.
#pragma once

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

#include "cachesim/gpus/gpu.hpp"
#include "cachesim/report/timed_report.hpp"
#include "tools/jobs/launch_source.hpp"
#include "tools/jobs/observer.hpp"
#include "tools/jobs/replay_launches.hpp"

namespace raycache::tools {

/// The share of a kernel's warps that a GPU holds at once: a timed replay has its work with them only when no more
/// come.
inline double resident_share(const std::vector<cachesim::Gpu>& gpus, const traces::Header& header) {
    double share = 0;
    for (const cachesim::Gpu& gpu : gpus)
        share += std::min(1.0, static_cast<double>(gpu.sms) * gpu.warps_per_sm / header.warps_per_kernel());
    return share / static_cast<double>(gpus.size());
}

/// What a replay is called, and whether its work comes with the last warps as that of one in time does.
template <class Series>
struct ReplayStage {
    const char* name = "replay";
    bool timed = std::is_same_v<Series, cachesim::TimedSeries>;
};

/// Makes a series of every source and GPU, sources first, with replays that make_replay(gpu, regions, sample) makes:
/// they take push(warp) and, where launches have several kernels, end_kernel(), and their finish() is one of
/// Series::launches. Series is an Origin.
template <class Series, class MakeReplay>
std::vector<Series> replay_with(const std::vector<LaunchSource>& sources, const std::vector<cachesim::Gpu>& gpus,
                                Observer& observer, const MakeReplay& make_replay,
                                const ReplayStage<Series>& named = {}) {
    std::vector<Series> series;
    std::vector<std::pair<std::size_t, std::uint32_t>> tasks;  // source, launch
    std::uint64_t warps = 0;
    for (std::size_t s = 0; s < sources.size(); ++s) {
        const traces::Header& header = *sources[s].header;
        for (const cachesim::Gpu& gpu : gpus) {
            Series& made = series.emplace_back();
            static_cast<cachesim::Origin&>(made) = origin_of(sources[s], gpu);
            if constexpr (requires { made.no_time; }) {
                made.no_time = cachesim::no_time_note(gpu);
                made.traversal = cachesim::traversal_name(gpu);
            }
            made.launches.resize(header.launches.size());
        }
        for (std::uint32_t launch = 0; launch < header.launches.size(); ++launch) tasks.emplace_back(s, launch);
        warps += std::uint64_t{header.warps_per_launch} * header.launches.size();
    }

    constexpr std::uint64_t parts = 100;  // of a warp's work
    const Stage stage(observer, named.name, parts * warps, "rays");
    const auto run_task = [&](std::size_t task) {
        const auto [s, launch] = tasks[task];
        const traces::Header& header = *sources[s].header;
        const auto last_parts =
            named.timed ? static_cast<std::uint64_t>(resident_share(gpus, header) * static_cast<double>(parts)) : 0;
        std::vector<decltype(make_replay(gpus[0], header.regions, 0u))> replays;
        for (const cachesim::Gpu& gpu : gpus)
            replays.push_back(make_replay(gpu, header.regions, header.launches[launch]));
        sources[s].deliver(launch, [&](traces::WarpTrace&& warp) {
            const std::uint64_t rays = count_rays(warp);
            const auto shared = std::make_shared<const traces::WarpTrace>(std::move(warp));
            const bool new_kernel = shared->warp != 0 && shared->warp % header.warps_per_kernel() == 0;
            for (auto& r : replays) {
                if constexpr (requires { r.end_kernel(); })
                    if (new_kernel) r.end_kernel();
                r.push(shared);
            }
            stage.add(parts - last_parts, rays);
        });
        for (std::size_t g = 0; g < gpus.size(); ++g)
            series[s * gpus.size() + g].launches[launch] = replays[g].finish();
        stage.add(last_parts * header.warps_per_launch, 0);
    };
    // Each launch begins with cold caches, so launches are independent: one thread each.
    tbb::parallel_for(std::size_t{0}, tasks.size(), run_task, tbb::simple_partitioner());
    return series;
}

}  // namespace raycache::tools
