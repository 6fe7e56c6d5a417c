#include "tools/jobs/replay_launches.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <type_traits>

#include "cachesim/replay/l2_requests.hpp"
#include "cachesim/replay/replay.hpp"

namespace raycache::tools {
namespace {

/// The share of a kernel's warps that a GPU holds at once: a timed replay has its work with them only when no more
/// come.
template <class Series>
double resident_share(const std::vector<cachesim::Gpu>& gpus, const traces::Header& header) {
    if constexpr (!std::is_same_v<Series, cachesim::TimedSeries>) return 0;
    double share = 0;
    for (const cachesim::Gpu& gpu : gpus)
        share += std::min(1.0, static_cast<double>(gpu.sms) * gpu.warps_per_sm / header.warps_per_kernel());
    return share / static_cast<double>(gpus.size());
}

/// Makes a series of every source and GPU with replays that make_replay(gpu, regions, sample) makes.
template <class Series, class MakeReplay>
std::vector<Series> replay_with(const std::vector<LaunchSource>& sources, const std::vector<cachesim::Gpu>& gpus,
                                Observer& observer, const MakeReplay& make_replay) {
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
    const Stage stage(observer, "replay", parts * warps, "rays");
    const auto run_task = [&](std::size_t task) {
        const auto [s, launch] = tasks[task];
        const traces::Header& header = *sources[s].header;
        const auto last_parts =
            static_cast<std::uint64_t>(resident_share<Series>(gpus, header) * static_cast<double>(parts));
        std::vector<decltype(make_replay(gpus[0], header.regions, 0u))> replays;
        for (const cachesim::Gpu& gpu : gpus)
            replays.push_back(make_replay(gpu, header.regions, header.launches[launch]));
        sources[s].deliver(launch, [&](traces::WarpTrace&& warp) {
            const std::uint64_t rays = count_rays(warp);
            const auto shared = std::make_shared<const traces::WarpTrace>(std::move(warp));
            const bool new_kernel = shared->warp != 0 && shared->warp % header.warps_per_kernel() == 0;
            for (auto& r : replays) {
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

/// A functional and a timed replay, fed alike.
class BothReplays {
public:
    BothReplays(const cachesim::Gpu& gpu, const std::vector<traces::Region>& regions, std::uint32_t sample)
        : counted_(gpu, regions, sample), timed_(gpu, regions, sample) {}

    void push(const std::shared_ptr<const traces::WarpTrace>& warp) {
        counted_.push(warp);
        timed_.push(warp);
    }
    void end_kernel() {
        counted_.end_kernel();
        timed_.end_kernel();
    }
    std::pair<cachesim::LaunchStatistics, cachesim::TimedStatistics> finish() {
        return {counted_.finish(), timed_.finish()};
    }

private:
    cachesim::Replay counted_;
    cachesim::TimedReplay timed_;
};

/// What one launch of a ProfiledSeries is.
struct ProfiledLaunch {
    cachesim::LaunchStatistics counted, instructions;
    std::optional<cachesim::TimedStatistics> time;
};

/// A functional replay that is listened to and, if asked for, a timed one, fed alike.
class ProfilingReplay {
public:
    ProfilingReplay(const cachesim::Gpu& gpu, const std::vector<traces::Region>& regions, std::uint32_t sample,
                    bool timed)
        : requests_(std::make_unique<cachesim::L2RequestCounter>(gpu, regions)), counted_(gpu, regions, sample) {
        counted_.observe(*requests_);
        if (timed) timed_.emplace(gpu, regions, sample);
    }

    void push(const std::shared_ptr<const traces::WarpTrace>& warp) {
        counted_.push(warp);
        if (timed_) timed_->push(warp);
    }
    void end_kernel() {
        counted_.end_kernel();
        if (timed_) timed_->end_kernel();
    }
    ProfiledLaunch finish() {
        ProfiledLaunch launch;
        launch.counted = counted_.finish();
        launch.instructions = requests_->in_instructions(launch.counted);
        if (timed_) launch.time = timed_->finish();
        return launch;
    }

private:
    std::unique_ptr<cachesim::L2RequestCounter> requests_;  ///< must not move
    cachesim::Replay counted_;
    std::optional<cachesim::TimedReplay> timed_;
};

struct ProfiledLaunches : cachesim::Origin {
    std::vector<ProfiledLaunch> launches;
};

/// A series of both.
struct BothSeries : cachesim::Series {
    std::string no_time, traversal;
    std::vector<std::pair<cachesim::LaunchStatistics, cachesim::TimedStatistics>> launches;
};

}  // namespace

cachesim::Origin origin_of(const LaunchSource& source, const cachesim::Gpu& gpu) {
    const traces::Provenance& p = source.header->provenance;
    return {p.scene,      to_string(source.strategy),
            p.sequence,   p.parameters,
            p.thread_map, gpu.name,
            p.spp,        {gpu.levels.size(), gpu.l1().sector_bytes}};
}

std::vector<cachesim::Series> replay(const std::vector<LaunchSource>& sources, const std::vector<cachesim::Gpu>& gpus,
                                     Observer& observer) {
    return replay_with<cachesim::Series>(sources, gpus, observer,
                                         [](const cachesim::Gpu& gpu, const std::vector<traces::Region>& regions,
                                            std::uint32_t sample) { return cachesim::Replay(gpu, regions, sample); });
}

std::vector<cachesim::TimedSeries> replay_timed(const std::vector<LaunchSource>& sources,
                                                const std::vector<cachesim::Gpu>& gpus, Observer& observer,
                                                const cachesim::Idealised& ideal) {
    return replay_with<cachesim::TimedSeries>(
        sources, gpus, observer,
        [&](const cachesim::Gpu& gpu, const std::vector<traces::Region>& regions, std::uint32_t sample) {
            return cachesim::TimedReplay(gpu, regions, sample, ideal);
        });
}

Predicted predict(const std::vector<LaunchSource>& sources, const std::vector<cachesim::Gpu>& gpus,
                  Observer& observer) {
    Predicted all;
    for (BothSeries& both :
         replay_with<BothSeries>(sources, gpus, observer,
                                 [](const cachesim::Gpu&gpu, const std::vector<traces::Region>&regions,
                                    std::uint32_t sample) { return BothReplays(gpu, regions, sample); })) {
        cachesim::Series& counted = all.traffic.emplace_back(both);
        cachesim::TimedSeries& timed = all.times.emplace_back();
        static_cast<cachesim::Origin&>(timed) = both;
        timed.no_time = both.no_time;
        timed.traversal = both.traversal;
        for (auto& [counts, times] : both.launches) {
            counted.launches.push_back(std::move(counts));
            timed.launches.push_back(times);
        }
    }
    return all;
}

std::vector<cachesim::ProfiledSeries> profile(const std::vector<LaunchSource>& sources,
                                              const std::vector<cachesim::Gpu>& gpus, bool timed, Observer& observer) {
    std::vector<cachesim::ProfiledSeries> all;
    for (ProfiledLaunches& made : replay_with<ProfiledLaunches>(
             sources, gpus, observer,
             [&](const cachesim::Gpu&gpu, const std::vector<traces::Region>&regions, std::uint32_t sample) {
                 return ProfilingReplay(gpu, regions, sample, timed && cachesim::no_time_note(gpu).empty());
             })) {
        cachesim::ProfiledSeries& series = all.emplace_back();
        static_cast<cachesim::Origin&>(series) = made;
        for (ProfiledLaunch& launch : made.launches) {
            series.launches.push_back(std::move(launch.counted));
            series.instructions.push_back(std::move(launch.instructions));
            if (launch.time) series.times.push_back(*launch.time);
        }
    }
    return all;
}

}  // namespace raycache::tools
