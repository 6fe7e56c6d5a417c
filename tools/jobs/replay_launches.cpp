#include "tools/jobs/replay_launches.hpp"

#include <memory>
#include <optional>

#include "cachesim/analysis/l2_requests.hpp"
#include "cachesim/replay/replay.hpp"
#include "cachesim/replay/timed/timed_replay.hpp"
#include "tools/jobs/replay_with.hpp"

namespace raycache::tools {
namespace {

/// What replays of one launch that are fed alike have counted.
struct ReplayedLaunch {
    cachesim::LaunchStatistics counted;
    std::optional<cachesim::LaunchStatistics> instructions;  ///< where it was asked for: in_instructions()
    std::optional<cachesim::TimedStatistics> time;
};

/// A functional replay, listened to by what a profiler needs if that is asked for, and a timed one if that is.
class ReplaysTogether {
public:
    ReplaysTogether(const cachesim::Gpu& gpu, const std::vector<traces::Region>& regions, std::uint32_t sample,
                    bool profiled, bool timed)
        : counted_(gpu, regions, sample) {
        if (profiled) counted_.observe(*(requests_ = std::make_unique<cachesim::L2RequestCounter>(gpu, regions)));
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
    ReplayedLaunch finish() {
        ReplayedLaunch launch{counted_.finish(), {}, {}};
        if (requests_) launch.instructions = requests_->in_instructions(launch.counted);
        if (timed_) launch.time = timed_->finish();
        return launch;
    }

private:
    std::unique_ptr<cachesim::L2RequestCounter> requests_;  ///< must not move
    cachesim::Replay counted_;
    std::optional<cachesim::TimedReplay> timed_;
};

struct ReplayedSeries : cachesim::Origin {
    std::string no_time, traversal;
    std::vector<ReplayedLaunch> launches;
};

}  // namespace

cachesim::Origin origin_of(const LaunchSource& source, const cachesim::Gpu& gpu) {
    const traces::Provenance& p = source.header->provenance;
    return {p.scene,      to_string(source.strategy),
            p.sequence,   p.parameters,
            p.thread_map, gpu.name,
            p.spp,        {gpu.levels.size(), gpu.l1().sector_bytes},
            {},           source.indices};
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
    for (ReplayedSeries& both : replay_with<ReplayedSeries>(
             sources, gpus, observer,
             [](const cachesim::Gpu&gpu, const std::vector<traces::Region>&regions, std::uint32_t sample) {
                 return ReplaysTogether(gpu, regions, sample, false, true);
             })) {
        cachesim::Series& counted = all.traffic.emplace_back();
        cachesim::TimedSeries& timed = all.times.emplace_back();
        static_cast<cachesim::Origin&>(counted) = both;
        static_cast<cachesim::Origin&>(timed) = both;
        timed.no_time = both.no_time;
        timed.traversal = both.traversal;
        for (ReplayedLaunch& launch : both.launches) {
            counted.launches.push_back(std::move(launch.counted));
            timed.launches.push_back(*launch.time);
        }
    }
    return all;
}

std::vector<cachesim::ProfiledSeries> profile(const std::vector<LaunchSource>& sources,
                                              const std::vector<cachesim::Gpu>& gpus, bool timed, Observer& observer) {
    std::vector<cachesim::ProfiledSeries> all;
    for (ReplayedSeries& made : replay_with<ReplayedSeries>(
             sources, gpus, observer,
             [&](const cachesim::Gpu&gpu, const std::vector<traces::Region>&regions, std::uint32_t sample) {
                 return ReplaysTogether(gpu, regions, sample, true, timed && cachesim::no_time_note(gpu).empty());
             })) {
        cachesim::ProfiledSeries& series = all.emplace_back();
        static_cast<cachesim::Origin&>(series) = made;
        for (ReplayedLaunch& launch : made.launches) {
            series.launches.push_back(std::move(launch.counted));
            series.instructions.push_back(std::move(*launch.instructions));
            if (launch.time) series.times.push_back(*launch.time);
        }
    }
    return all;
}

}  // namespace raycache::tools
