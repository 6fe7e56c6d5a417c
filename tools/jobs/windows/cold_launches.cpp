#include "tools/jobs/windows/cold_launches.hpp"

#include <fmt/format.h>

#include <memory>
#include <optional>
#include <utility>

#include "cachesim/replay/replay.hpp"
#include "cachesim/replay/timed/launch_stages.hpp"
#include "cachesim/report/explanation.hpp"
#include "tools/jobs/costs.hpp"
#include "tools/jobs/launch_source.hpp"
#include "tools/jobs/replay_with.hpp"
#include "tools/jobs/windows/launch_extent.hpp"
#include "traces/error.hpp"

namespace raycache::tools {
namespace {

constexpr const char* stage_of_cold_launches = "cold launches";

tracer::CaptureSettings of_whole_launches(const WindowedStrategy& strategy, std::uint64_t count) {
    tracer::CaptureSettings settings = strategy.capture;
    settings.trace_samples = count * extent_of(settings).indices;
    return settings;
}

struct ColdLaunch {
    cachesim::LaunchStatistics counted;
    std::optional<cachesim::LaunchStages> stages;
};

class ColdReplay {
public:
    ColdReplay(const cachesim::Gpu& gpu, const std::vector<traces::Region>& regions, std::uint32_t sample, bool timed)
        : counted_(gpu, regions, sample) {
        if (timed && cachesim::no_time_note(gpu).empty()) staged_.emplace(gpu, regions, sample);
    }
    void push(const std::shared_ptr<const traces::WarpTrace>& warp) {
        counted_.push(warp);
        if (staged_) staged_->push(warp);
    }
    ColdLaunch finish() {
        ColdLaunch launch{counted_.finish(), {}};
        if (staged_) launch.stages = staged_->finish();
        return launch;
    }

private:
    cachesim::Replay counted_;
    std::optional<cachesim::StagedReplay> staged_;
};

struct ColdSeries : cachesim::Origin {
    std::vector<ColdLaunch> launches;
};

}  // namespace

void check_cold_launches(const std::vector<WindowedStrategy>& strategies, std::uint64_t count) {
    for (const WindowedStrategy& strategy : strategies) {
        const LaunchExtent extent = extent_of(strategy.capture);
        if (count > extent.launches)
            throw UsageError(fmt::format(
                "{} cold launches; expected 1 to {}: N is {}, and a launch of {} has {} sample {}", count,
                extent.launches, strategy.capture.strategy.samples.spp, strategy.capture.strategy.decorrelation,
                extent.indices, extent.indices == 1 ? "index" : "indices"));
    }
}

void expect_cold_launches(const std::vector<WindowedStrategy>& strategies, std::uint64_t count,
                          const std::vector<cachesim::Gpu>& gpus, bool timed, Observer& observer) {
    double seconds = 0;
    for (const WindowedStrategy& strategy : strategies) {
        const tracer::CaptureSettings settings = of_whole_launches(strategy, count);
        seconds += trace_cost(settings) + static_cast<double>(gpus.size()) * replay_cost(settings, timed);
    }
    observer.expect(stage_of_cold_launches, timed ? Work::timed_replay : Work::replay, seconds);
}

std::vector<cachesim::ColdLaunches> replay_cold_launches(const tracer::PreparedScene& scene,
                                                         const std::vector<WindowedStrategy>& strategies,
                                                         std::uint64_t count, const std::vector<cachesim::Gpu>& gpus,
                                                         bool timed, Observer& observer) {
    std::vector<std::unique_ptr<tracer::Capture>> captures;
    for (const WindowedStrategy& strategy : strategies)
        captures.push_back(
            std::make_unique<tracer::Capture>(scene.in_layout(strategy.layout), of_whole_launches(strategy, count)));
    const auto made =
        replay_with<ColdSeries>(sources_of(captures), gpus, observer,
                                [&](const cachesim::Gpu& gpu, const std::vector<traces::Region>& regions,
                                    std::uint32_t sample) { return ColdReplay(gpu, regions, sample, timed); },
                                {stage_of_cold_launches, timed});
    std::vector<cachesim::ColdLaunches> all;
    for (const ColdSeries& series : made) {
        cachesim::ColdLaunches& cold = all.emplace_back();
        for (const ColdLaunch& launch : series.launches) {
            cold.launches.push_back(launch.counted);
            if (launch.stages) cold.stages.push_back(*launch.stages);
        }
    }
    return all;
}

}  // namespace raycache::tools
