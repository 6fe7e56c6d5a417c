#include "tools/replay_job.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>

#include "cachesim/replay/replay.hpp"
#include "tools/console.hpp"
#include "traces/read_launch.hpp"
#include "traces/reader.hpp"

namespace raycache::tools {
namespace {

/// Hands over the warps of one launch, in order.
using Sink = std::function<void(traces::WarpTrace&&)>;

/// Something that has launches.
struct Source {
    const traces::Header* header;
    std::function<void(std::uint32_t launch, const Sink&)> deliver;  ///< thread-safe
};

std::uint64_t count_rays(const traces::WarpTrace& warp) {
    std::uint64_t rays = 0;
    for (const traces::Record& record : warp.records)
        if (!record.is_access()) rays += record.lanes();
    return rays;
}

/// Makes a series of every source and GPU with replays that make_replay(gpu, regions, sample) makes.
template <class Series, class MakeReplay>
std::vector<Series> replay(const std::vector<Source>& sources, const std::vector<cachesim::Gpu>& gpus,
                           const MakeReplay& make_replay) {
    std::vector<Series> series;
    std::vector<std::pair<std::size_t, std::uint32_t>> tasks;  // source, launch
    std::uint64_t warps = 0;
    for (std::size_t s = 0; s < sources.size(); ++s) {
        const traces::Header& header = *sources[s].header;
        const traces::Provenance& p = header.provenance;
        for (const cachesim::Gpu& gpu : gpus) {
            Series& made = series.emplace_back();
            made.scene = p.scene;
            made.strategy = p.decorrelation;
            made.sequence = p.sequence;
            made.parameters = p.parameters;
            made.thread_map = p.thread_map;
            made.gpu = gpu.name;
            made.sector_bytes = gpu.l1().sector_bytes;
            if constexpr (requires { made.levels; }) made.levels = gpu.levels.size();
            made.spp = p.spp;
            made.launches.resize(header.launches.size());
        }
        for (std::uint32_t launch = 0; launch < header.launches.size(); ++launch) tasks.emplace_back(s, launch);
        warps += std::uint64_t{header.warps_per_launch} * header.launches.size();
    }

    ProgressBar bar("replay", warps, "rays");
    const auto run_task = [&](std::size_t task) {
        const auto [s, launch] = tasks[task];
        const traces::Header& header = *sources[s].header;
        std::vector<decltype(make_replay(gpus[0], header.regions, 0u))> replays;
        for (const cachesim::Gpu& gpu : gpus)
            replays.push_back(make_replay(gpu, header.regions, header.launches[launch]));
        sources[s].deliver(launch, [&](traces::WarpTrace&& warp) {
            const std::uint64_t rays = count_rays(warp);
            const auto shared = std::make_shared<const traces::WarpTrace>(std::move(warp));
            for (auto& r : replays) r.push(shared);
            bar.add(1, rays);
        });
        for (std::size_t g = 0; g < gpus.size(); ++g)
            series[s * gpus.size() + g].launches[launch] = replays[g].finish();
    };
    // Each launch begins with cold caches, so launches are independent: one thread each.
    tbb::parallel_for(std::size_t{0}, tasks.size(), run_task, tbb::simple_partitioner());
    return series;
}

std::vector<cachesim::Series> replay_functional(const std::vector<Source>& sources,
                                                const std::vector<cachesim::Gpu>& gpus) {
    return replay<cachesim::Series>(
        sources, gpus, [](const cachesim::Gpu& gpu, const std::vector<traces::Region>& regions, std::uint32_t sample) {
            return cachesim::Replay(gpu, regions, sample);
        });
}

std::vector<cachesim::TimedSeries> replay_timed(const std::vector<Source>& sources,
                                                const std::vector<cachesim::Gpu>& gpus,
                                                const cachesim::Idealised& ideal) {
    return replay<cachesim::TimedSeries>(
        sources, gpus, [&](const cachesim::Gpu& gpu, const std::vector<traces::Region>& regions, std::uint32_t sample) {
            return cachesim::TimedReplay(gpu, regions, sample, ideal);
        });
}

/// Opens trace files and keeps them open.
struct Files {
    explicit Files(const std::vector<std::string>& paths) {
        for (const std::string& path : paths) {
            readers.push_back(std::make_unique<traces::Reader>(path));
            const traces::Reader* reader = readers.back().get();
            sources.push_back({&reader->header(), [reader](std::uint32_t launch, const Sink& sink) {
                                   traces::read_launch(*reader, launch, sink);
                               }});
        }
    }
    std::vector<std::unique_ptr<traces::Reader>> readers;
    std::vector<Source> sources;
};

std::vector<Source> sources_of(const std::vector<std::unique_ptr<tracer::Capture>>& captures) {
    std::vector<Source> sources;
    for (const auto& owned : captures) {
        const tracer::Capture* capture = owned.get();
        sources.push_back({&capture->header(), [capture](std::uint32_t launch, const Sink& sink) {
                               const auto worker = capture->make_worker();
                               for (std::uint32_t warp = 0; warp < capture->header().warps_per_launch; ++warp) {
                                   traces::WarpTrace trace;
                                   capture->trace_warp(*worker, launch, warp, trace);
                                   sink(std::move(trace));
                               }
                           }});
    }
    return sources;
}

}  // namespace

std::vector<cachesim::Series> replay_files(const std::vector<std::string>& paths,
                                           const std::vector<cachesim::Gpu>& gpus) {
    const Files files(paths);
    return replay_functional(files.sources, gpus);
}

std::vector<cachesim::TimedSeries> replay_files_timed(const std::vector<std::string>& paths,
                                                      const std::vector<cachesim::Gpu>& gpus,
                                                      const cachesim::Idealised& ideal) {
    const Files files(paths);
    return replay_timed(files.sources, gpus, ideal);
}

std::vector<cachesim::Series> replay_captures(const std::vector<std::unique_ptr<tracer::Capture>>& captures,
                                              const std::vector<cachesim::Gpu>& gpus) {
    return replay_functional(sources_of(captures), gpus);
}

std::vector<cachesim::TimedSeries> replay_captures_timed(const std::vector<std::unique_ptr<tracer::Capture>>& captures,
                                                         const std::vector<cachesim::Gpu>& gpus,
                                                         const cachesim::Idealised& ideal) {
    return replay_timed(sources_of(captures), gpus, ideal);
}

}  // namespace raycache::tools
