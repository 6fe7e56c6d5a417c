#include "tools/jobs/curve_job.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <numeric>

#include "cachesim/replay/replay.hpp"
#include "tools/jobs/costs.hpp"
#include "tools/jobs/replay_launches.hpp"
#include "traces/error.hpp"

namespace raycache::tools {
namespace {

std::vector<std::size_t> levels_of(const CurveJob& job, const cachesim::Gpu& gpu) {
    if (!job.levels.empty()) return job.levels;
    std::vector<std::size_t> all(gpu.levels.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    return all;
}

/// The GPU's own sets first, then one set of all lines, then what was asked for.
std::vector<cachesim::CacheGeometry> rows_of(const CurveJob& job, const cachesim::CacheGeometry& own) {
    std::vector<cachesim::CacheGeometry> rows{own};
    if (own.sets * own.slices != 1) rows.push_back(cachesim::fully_associative(own));
    for (const std::uint64_t sets : job.sets)
        if (sets != own.sets && sets * own.slices != 1) rows.push_back(cachesim::with_sets(own, sets));
    return rows;
}

/// What one launch says of all levels.
struct LaunchCurves {
    double rays = 0;
    std::vector<std::vector<cachesim::WaysCurve>> curves;  ///< by level, by row
    std::vector<double> asked;                             ///< by level
    std::vector<std::uint64_t> look_ups;
    std::uint64_t memory_bytes = 0;
};

LaunchCurves curves_of(const LaunchSource& source, std::uint32_t launch, const CurveJob& job, const cachesim::Gpu& gpu,
                       const Stage& stage) {
    const traces::Header& header = *source.header;
    std::vector<std::unique_ptr<cachesim::LruSurface>> surfaces;
    cachesim::Replay replay(gpu, header.regions, header.launches[launch]);
    for (const std::size_t level : levels_of(job, gpu)) {
        surfaces.push_back(std::make_unique<cachesim::LruSurface>(level, rows_of(job, gpu.levels[level])));
        replay.observe(*surfaces.back());
    }
    source.deliver(launch, [&](traces::WarpTrace&& warp) {
        const std::uint64_t rays = count_rays(warp);
        replay.push(std::make_shared<const traces::WarpTrace>(std::move(warp)));
        stage.add(1, rays);
    });
    const cachesim::Counters all = replay.finish().all();
    LaunchCurves result;
    result.rays = static_cast<double>(all.rays);
    const auto levels = levels_of(job, gpu);
    for (std::size_t l = 0; l < levels.size(); ++l) {
        result.curves.push_back(surfaces[l]->curves());
        result.asked.push_back(static_cast<double>(levels[l] == 0 ? all.requests : all.levels[levels[l]].sectors));
        result.look_ups.push_back(surfaces[l]->look_ups());
        result.memory_bytes += surfaces[l]->bytes();
    }
    return result;
}

}  // namespace

void CurveJob::check(const cachesim::Gpu& loaded) const {
    launches.check();
    for (const std::size_t level : levels)
        if (level >= loaded.levels.size())
            throw UsageError(fmt::format("level l{}; expected l1 to l{}, the levels of {}", level + 1,
                                         loaded.levels.size(), loaded.name));
    if (sizes.empty()) return;
    if (levels.size() != 1) throw UsageError("sizes of all levels; expected those of one, such as --level l1");
    const cachesim::CacheGeometry& own = loaded.levels[levels.front()];
    const std::uint64_t way = own.slices * own.sets * own.line_bytes;
    for (const std::uint64_t size : sizes) {
        if (size % way == 0) continue;
        const std::uint64_t below = size / way * way;
        throw UsageError(fmt::format(
            "--sizes {} bytes: expected a whole number of ways of {} of the {} of {}; the nearest {}", size,
            cachesim::short_size(way), cachesim::level_name(levels.front()), loaded.name,
            below == 0 ? "is " + cachesim::short_size(way)
                       : fmt::format("are {} and {}", cachesim::short_size(below), cachesim::short_size(below + way))));
    }
}

CurveResult run(const CurveJob& job, const cachesim::Gpu& gpu, Observer& observer, const FileNames& outputs) {
    job.check(gpu);
    if (!job.launches.of_traces()) {
        double seconds = 0;
        for (const auto& s : job.launches.captures()) seconds += trace_cost(s) + 2 * replay_cost(s, false);
        observer.expect("replay", Work::replay, seconds);
    }
    const Launches launches(job.launches, outputs, observer);
    const auto& sources = launches.sources();
    CurveResult result{{{gpu_json(gpu)}, launches.subject()}, {}};
    std::vector<std::vector<LaunchCurves>> found(sources.size());
    std::vector<std::pair<std::size_t, std::uint32_t>> tasks;
    std::uint64_t warps = 0;
    for (std::size_t s = 0; s < sources.size(); ++s) {
        const traces::Header& header = *sources[s].header;
        refuse_wavefront(header, launches.names()[s], "curve");
        found[s].resize(header.launches.size());
        for (std::uint32_t launch = 0; launch < header.launches.size(); ++launch) tasks.emplace_back(s, launch);
        warps += std::uint64_t{header.warps_per_launch} * header.launches.size();
    }
    {
        const Stage stage(observer, "replay", warps, "rays");
        // Each launch begins with cold caches, so launches are independent: one thread each.
        tbb::parallel_for(
            std::size_t{0}, tasks.size(),
            [&](std::size_t task) {
                const auto [s, launch] = tasks[task];
                found[s][launch] = curves_of(sources[s], launch, job, gpu, stage);
            },
            tbb::simple_partitioner());
    }
    const auto levels = levels_of(job, gpu);
    for (std::size_t s = 0; s < sources.size(); ++s) {
        cachesim::CurveSeries& series = result.series.emplace_back();
        static_cast<cachesim::Origin&>(series) = origin_of(sources[s], gpu);
        series.samples = sources[s].header->launches;
        for (std::size_t l = 0; l < levels.size(); ++l) {
            cachesim::LevelCurve& level = series.levels.emplace_back();
            level.level = levels[l];
            for (const cachesim::CacheGeometry& row : rows_of(job, gpu.levels[levels[l]]))
                level.rows.push_back({row, {}});
            for (LaunchCurves& launch : found[s]) {
                level.rays.push_back(launch.rays);
                level.asked.push_back(launch.asked[l]);
                level.look_ups += launch.look_ups[l];
                for (std::size_t r = 0; r < level.rows.size(); ++r)
                    level.rows[r].launches.push_back(std::move(launch.curves[l][r]));
            }
        }
        for (const LaunchCurves& launch : found[s])
            series.memory_bytes = std::max(series.memory_bytes, launch.memory_bytes);
    }
    return result;
}

}  // namespace raycache::tools
