#include "tools/bench/tradeoff/ladder.hpp"

#include <fmt/format.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <ctime>
#include <functional>
#include <numeric>

#include "cachesim/replay/replay.hpp"
#include "cachesim/replay/timed/timed_replay.hpp"
#include "tools/bench/tradeoff/no_cache_models.hpp"
#include "tools/jobs/windows/estimator.hpp"
#include "tools/jobs/windows/steady_replay.hpp"
#include "traces/error.hpp"

namespace raycache::bench {
namespace {

/// The first look of an estimate.
constexpr std::uint32_t first_look = 8;

/// Of all threads of this process, in user and system mode.
double cpu_seconds() {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

template <class Work>
void timed(double& seconds, Work&& work) {
    const double start = cpu_seconds();
    work();
    seconds += cpu_seconds() - start;
}

Answer answer(const Demand& d, double cycles, const cachesim::Gpu& gpu) {
    const auto l1 = static_cast<double>(d.l1), l2 = static_cast<double>(d.l2), dram = static_cast<double>(d.dram);
    const auto rays = static_cast<double>(d.rays);
    const double sector = gpu.l1().sector_bytes;
    return {1 - l2 / l1, 1 - dram / l2, sector * l2 / rays, sector * dram / rays, cycles / rays};
}

/// The levels that see every warp of a strategy.
class WholeLaunches {
public:
    WholeLaunches(const tools::LaunchSettings& launches, const tracer::PreparedScene& scene, const cachesim::Gpu& gpu,
                  Ladder& ladder)
        : gpu_(gpu), scene_(scene), launches_(launches), ladder_(ladder) {
        for (const char* name : {"unique sectors", "reuse distances", "functional exact", "timed exact"})
            results_.push_back({name, 0, 0, 0, 0, {}});
    }

    void run(std::size_t strategy) {
        tracer::CaptureSettings settings = launches_.captures()[strategy];
        const std::uint64_t n = settings.strategy.samples.spp;
        settings.first_indices.resize(n);
        std::iota(settings.first_indices.begin(), settings.first_indices.end(), 0U);
        const tracer::Capture capture(scene_, settings);
        const auto& regions = capture.header().regions;
        ladder_.warps = capture.header().warps_per_launch;
        unique_.emplace(gpu_, regions);
        reuse_.emplace(gpu_, regions);
        counted_.emplace(gpu_, regions, 0);
        timed_.emplace(gpu_, regions, 0);
        bool counts = false;
        const auto count = [&](bool from_here) {
            counts = from_here;
            if (from_here) {
                counted_->count_from_here();
                timed_->count_from_here();
            } else {
                counted_->count_until_here();
                timed_->count_until_here();
            }
        };
        tools::walk_steady(tools::extent_of(settings), ladder_.wave,
                           {[&](std::uint32_t launch, std::uint32_t warps) { push(capture, launch, warps, counts); },
                            [&] { count(true); }, [&] { count(false); }});
        finish();
    }

    const std::vector<LevelResult>& results() {
        for (LevelResult& result : results_) result.seconds += ladder_.trace_seconds;
        return results_;
    }

private:
    Wave trace(const tracer::Capture& capture, std::uint32_t launch, std::uint32_t begin, std::uint32_t end) {
        Wave wave;
        timed(ladder_.trace_seconds, [&] {
            if (!worker_ || worker_of_ != &capture) worker_ = capture.make_worker();
            worker_of_ = &capture;
            for (std::uint32_t warp = begin; warp < end; ++warp) {
                auto trace = std::make_shared<traces::WarpTrace>();
                capture.trace_warp(*worker_, launch, warp, *trace);
                wave.push_back(std::move(trace));
            }
        });
        return wave;
    }

    void push(const tracer::Capture& capture, std::uint32_t launch, std::uint32_t warps, bool counted) {
        for (std::uint32_t warp = 0; warp < warps; warp += ladder_.wave)
            push_wave(trace(capture, launch, warp, std::min(warp + ladder_.wave, warps)), counted);
    }

    void push_wave(const Wave& wave, bool counted) {
        timed(results_[0].seconds, [&] { unique_->wave(wave, counted); });
        timed(results_[1].seconds, [&] { reuse_->wave(wave, counted); });
        timed(results_[2].seconds, [&] {
            for (const auto& warp : wave) counted_->push(warp);
        });
        timed(results_[3].seconds, [&] {
            for (const auto& warp : wave) timed_->push(warp);
        });
    }

    void finish() {
        Demand functional;
        timed(results_[2].seconds, [&] { functional += counted_->finish(); });
        cachesim::TimedStatistics times;
        timed(results_[3].seconds, [&] { times = timed_->finish(); });
        ladder_.warp_instructions += times.instructions;
        ladder_.issue_busy.push_back(times.issue.busy /
                                     (static_cast<double>(times.issue.copies) * static_cast<double>(times.cycles)));
        for (std::size_t level = 0; level < results_.size(); ++level) {
            const Demand& demand = level == 0 ? unique_->counts() : level == 1 ? reuse_->counts() : functional;
            const double cycles = level == 3 ? static_cast<double>(times.cycles) : roofline_cycles(demand, gpu_);
            results_[level].answers.push_back(answer(demand, cycles, gpu_));
        }
        worker_.reset();
    }

    const cachesim::Gpu& gpu_;
    const tracer::PreparedScene& scene_;
    const tools::LaunchSettings& launches_;
    Ladder& ladder_;
    std::vector<LevelResult> results_;
    std::unique_ptr<tracer::Capture::Worker> worker_;
    const tracer::Capture* worker_of_ = nullptr;
    std::optional<UniqueSectors> unique_;
    std::optional<ReuseDistances> reuse_;
    std::optional<cachesim::Replay> counted_;
    std::optional<cachesim::TimedReplay> timed_;
};

std::vector<Answer> answers(const tools::Predicted& predicted, const cachesim::Gpu& gpu) {
    std::vector<Answer> all;
    for (std::size_t s = 0; s < predicted.traffic.size(); ++s) {
        Demand demand;
        for (const cachesim::LaunchStatistics& launch : predicted.traffic[s].launches) demand += launch;
        double cycles = roofline_cycles(demand, gpu);
        if (!predicted.times.empty()) {
            cachesim::TimedStatistics times;
            for (const cachesim::TimedStatistics& launch : predicted.times[s].launches) times += launch;
            cycles =
                static_cast<double>(times.cycles) / static_cast<double>(times.rays) * static_cast<double>(demand.rays);
        }
        all.push_back(answer(demand, cycles, gpu));
    }
    return all;
}

/// One estimate that is asked for one target after the other, so the seconds of each contain those of the one before.
void estimate(const LadderSettings& s, const tracer::PreparedScene& scene, const std::vector<cachesim::Gpu>& gpus,
              bool in_time, std::uint32_t drawing, tools::Observer& observer, std::vector<LevelResult>& results) {
    tools::EstimateSettings settings;
    settings.windows = true;
    double seconds = 0;
    std::optional<tools::Estimator> estimator;
    timed(seconds, [&] {
        estimator.emplace(scene, tools::strategies_of(s.launches), settings, gpus,
                          std::vector<cachesim::Idealised>(in_time ? 1 : 0), false, observer,
                          tools::WindowChoice{s.sizes, drawing});
    });
    const std::string& baseline = estimator->cases().front().name;
    auto target = s.targets.begin();
    for (std::uint32_t blocks = first_look; blocks <= s.most_blocks && target != s.targets.end(); blocks *= 2) {
        tools::Worst worst;
        timed(seconds, [&] { worst = estimator->look(blocks, baseline); });
        for (; target != s.targets.end() && worst.error <= *target; ++target)
            results.push_back({in_time ? "timed windows" : "functional windows", *target, drawing, blocks, seconds,
                               answers(estimator->result(), gpus.front())});
    }
}

}  // namespace

Ladder climb(const LadderSettings& s, tools::Observer& observer) {
    const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
    const std::vector<cachesim::Gpu> gpus{s.gpu.load_one({}, "tradeoff")};
    s.gpu.check_timed(gpus);
    if (!gpus.front().timing || gpus.front().levels.size() != 2)
        throw UsageError(fmt::format("{}; expected a GPU with a timing and two levels of caches", gpus.front().name));
    Ladder ladder;
    ladder.gpu = gpus.front().name;
    ladder.wave = tools::wave_warps(gpus.front());
    std::unique_ptr<tracer::PreparedScene> scene;
    timed(ladder.prepare_seconds, [&] { scene = s.launches.scene.prepare({}, observer); });

    WholeLaunches whole(s.launches, *scene, gpus.front(), ladder);
    for (std::size_t strategy = 0; strategy < s.launches.cases.size(); ++strategy) {
        ladder.strategies.push_back(to_string(s.launches.cases[strategy].strategy));
        observer.begin(fmt::format("exact: {}", ladder.strategies.back()), 1, "");
        whole.run(strategy);
    }
    ladder.levels = whole.results();
    for (std::uint32_t drawing = 1; drawing <= s.drawings; ++drawing)
        for (const bool in_time : {false, true}) estimate(s, *scene, gpus, in_time, drawing, observer, ladder.levels);
    return ladder;
}

}  // namespace raycache::bench
