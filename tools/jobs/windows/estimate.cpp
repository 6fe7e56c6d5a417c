#include "tools/jobs/windows/estimate.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <set>

#include "cachesim/report/verdict.hpp"
#include "tools/jobs/baseline.hpp"
#include "tools/jobs/costs.hpp"
#include "tools/jobs/windows/window_replay.hpp"
#include "tracer/sampling/pixel_place.hpp"
#include "tracer/simt/thread_map.hpp"
#include "traces/error.hpp"

namespace raycache::tools {
namespace {

constexpr std::uint32_t first_look = 8, most_blocks = 512;
constexpr double all_error = 0.05;  ///< of a 95 % interval

/// The windows of one strategy.
struct Case {
    WindowPlan plan;
    std::vector<std::uint32_t> first;  ///< sample index of each block
    std::unique_ptr<tracer::Capture> capture;
    std::vector<std::vector<BlockResult>> blocks;  ///< by block, then GPU
};

tracer::LaunchGrid grid_of(const tracer::CaptureSettings& s) {
    return {s.thread_map, s.width, s.height, s.strategy.samples.spp, tracer::interleave_of(s.strategy.parameters)};
}

Case make_case(const tracer::PreparedScene& scene, tracer::CaptureSettings settings, const WindowSizes& sizes,
               std::uint32_t blocks) {
    const tracer::LaunchGrid grid = grid_of(settings);
    const tracer::SampleSet& samples = settings.strategy.samples;
    Case c{{samples.spp, grid.warps(), grid.samples_per_launch(), samples.seed, sizes}, {}, nullptr, {}};
    c.first = c.plan.draw(blocks);
    for (const std::uint32_t first : c.first)
        for (std::uint32_t launch = 0; launch < c.plan.launches(); ++launch)
            settings.first_indices.push_back(first + launch * grid.samples_per_launch());
    c.capture = std::make_unique<tracer::Capture>(scene, settings);
    return c;
}

/// The largest relative error, and whose it is.
struct Worst {
    double error = 0;
    std::string of;

    void take(const cachesim::Estimate& e, const std::string& what) {
        const double relative =
            e.half_width ? *e.half_width / std::fabs(e.mean) : std::numeric_limits<double>::infinity();
        if (std::isfinite(e.mean) && !(relative <= error)) {
            error = relative;
            of = what;
        }
    }
};

/// Ratios where there is a baseline, else means.
Worst worst_of(const std::vector<cachesim::Series>& all, const std::string& baseline) {
    Worst worst;
    const cachesim::Report report = cachesim::make_report(all, baseline, cachesim::GroupBy::none);
    const bool compared = std::any_of(report.rows.begin(), report.rows.end(),
                                      [](const cachesim::Row& row) { return row["l2_bytes_ratio"].has_value(); });
    for (const cachesim::Row& row : report.rows) {
        const auto figures = cachesim::bytes_figures(row.caches.levels);
        for (std::size_t level = 0; level < figures.size(); ++level) {
            if (level + 1 == figures.size() && !row.windows->last_cache_full) continue;  // nothing steady to estimate
            const cachesim::TrafficKey key = compared ? figures[level].ratio : figures[level].mean;
            if (row[key])
                worst.take(*row[key], fmt::format("{} of {}", cachesim::traffic_figures[key.index].title,
                                                  cachesim::row_label(report, row)));
        }
    }
    return worst;
}

Worst worst_of(const std::vector<cachesim::TimedSeries>& all, const std::string& baseline) {
    Worst worst;
    const cachesim::TimedReport report = cachesim::make_timed_report(all, baseline);
    const bool compared = std::any_of(report.rows.begin(), report.rows.end(),
                                      [](const cachesim::TimedRow& row) { return row["speed_up"].has_value(); });
    for (const cachesim::TimedRow& row : report.rows) {
        const cachesim::TimedKey key = compared ? cachesim::TimedKey("speed_up") : cachesim::TimedKey("cycles_per_ray");
        if (row[key])
            worst.take(*row[key], fmt::format("{} of {}, N {}, {}", cachesim::timed_figures[key.index].title,
                                              row.strategy, row.spp, row.gpu));
    }
    return worst;
}

class Estimator {
public:
    Estimator(const tracer::PreparedScene& scene, const LaunchSettings& launches, const EstimateSettings& settings,
              const std::vector<cachesim::Gpu>& gpus, bool timed, Observer& observer)
        : settings_(settings), gpus_(gpus), timed_(timed), observer_(observer) {
        std::uint32_t blocks = most_blocks;
        if (settings.window_count != 0) {
            sizes_.windows =
                static_cast<std::uint32_t>(std::min<std::uint64_t>(sizes_.windows, settings.window_count / 2));
            sizes_.timed_windows = std::min(sizes_.timed_windows, sizes_.windows);
            blocks = static_cast<std::uint32_t>(settings.window_count / sizes_.windows);
        }
        for (std::size_t i = 0; i < launches.cases.size(); ++i) {
            cases_.push_back(make_case(scene, launches.captures()[i], sizes_, blocks));
            tracer::StrategyName name = tracer::strategy_name(cases_.back().capture->header().provenance);
            name.thread_map = launches.cases[i].strategy.thread_map;
            names_.push_back(to_string(name));
        }
    }

    void run();
    Predicted result() const { return series(error_of_look_); }
    std::vector<Json> subject() const;

private:
    static std::string stage_name(std::uint32_t end) { return fmt::format("windows of {} blocks", end); }
    void expect(std::uint32_t begin, std::uint32_t end);
    void run_blocks(std::uint32_t end);
    Predicted series(double error) const;
    cachesim::Origin origin(std::size_t c, std::size_t g, double error) const;
    Worst worst() const {
        const Predicted now = series(error_of_look_);
        return timed_ ? worst_of(now.times, baseline_of(now.times, settings_.baseline))
                      : worst_of(now.traffic, baseline_of(now.traffic, settings_.baseline));
    }
    void warn_of_pictures() const;

    const EstimateSettings& settings_;
    const std::vector<cachesim::Gpu>& gpus_;
    bool timed_;
    Observer& observer_;
    WindowSizes sizes_;
    std::vector<Case> cases_;
    std::vector<std::string> names_;
    std::uint32_t blocks_ = 0;
    double error_of_look_ = all_error;
};

void Estimator::warn_of_pictures() const {
    for (const cachesim::Gpu& gpu : gpus_) {
        const std::uint32_t wave = wave_warps(gpu), picture = cases_.front().capture->header().warps_per_launch;
        if (picture >= wave) continue;
        observer_.warn(fmt::format(
            "the picture has {} warps a sample and {} holds {} at once: several samples of it are under way together, "
            "as where a renderer launches them in one go",
            picture, gpu.name, wave));
    }
}

/// That these blocks are to come.
void Estimator::expect(std::uint32_t begin, std::uint32_t end) {
    double paths = sizes_.work_groups * sizes_.work_warps, longest = 0, replayed = 0, timed = 0;
    for (const cachesim::Gpu& gpu : gpus_) {
        const double wave = wave_warps(gpu), windows = (sizes_.warm_up_waves + sizes_.counted_waves) * wave;
        const double of_sms = 2.0 * sizes_.sm_windows * gpu.warps_per_cta;
        const double of_gpu = sizes_.windows * windows + 3 * wave;
        paths += of_sms;
        longest = std::max(longest, of_gpu);
        replayed += of_sms + of_gpu;
        if (timed_) timed += (1 + sizes_.timed_windows * (sizes_.timed_warm_up_waves + sizes_.counted_waves)) * wave;
    }
    const double count = traces::warp_lanes * (end - begin) * static_cast<double>(cases_.size());
    const std::uint32_t bounces = cases_.front().capture->settings().paths.bounces;
    observer_.expect(stage_name(end), timed_ ? Work::timed_replay : Work::replay,
                     window_cost(bounces, (paths + longest) * count, replayed * count, timed * count));
}

void Estimator::run_blocks(std::uint32_t end) {
    const std::uint32_t begin = blocks_;
    const std::size_t tasks = (end - begin) * cases_.size();
    for (Case& c : cases_) c.blocks.resize(end);
    const Stage stage(observer_, stage_name(end), tasks, "blocks");
    tbb::parallel_for(
        std::size_t{0}, tasks,
        [&](std::size_t task) {
            Case& c = cases_[task % cases_.size()];
            const std::size_t block = begin + task / cases_.size();
            c.blocks[block] = replay_block(*c.capture, static_cast<std::uint32_t>(block * c.plan.launches()), c.plan,
                                           c.plan.block(block, c.first[block]), sizes_, gpus_, timed_);
            stage.add(1, 1);
        },
        tbb::simple_partitioner());
    blocks_ = end;
}

/// Looks at 8, 16, 32 … blocks. Look number k, from 1, may err in a share 0.05 / 2^k of all cases, so that all of them
/// together err in less than 0.05: the union bound.
void Estimator::run() {
    warn_of_pictures();
    if (settings_.window_count != 0) {
        const auto blocks = static_cast<std::uint32_t>(settings_.window_count / sizes_.windows);
        expect(0, blocks);
        run_blocks(blocks);
        return;
    }
    using Clock = std::chrono::steady_clock;
    const auto start = Clock::now();
    const auto seconds = [&] { return std::chrono::duration<double>(Clock::now() - start).count(); };
    const bool budget = settings_.time_budget > 0;
    for (std::uint32_t end = budget ? 2 : first_look; end <= most_blocks; end *= 2) {
        const double before = seconds();
        if (blocks_ == 0) expect(0, end);
        run_blocks(end);
        error_of_look_ /= 2;
        const Worst now = worst();
        if (now.error <= settings_.target_error) return;
        // The half width falls with the square root of the blocks: those looks are still to come.
        for (std::uint32_t next = 2 * end; next <= most_blocks; next *= 2) {
            expect(next / 2, next);
            if (now.error * std::sqrt(end / static_cast<double>(next)) <= settings_.target_error) break;
        }
        const double last = seconds() - before;
        if (budget && seconds() + 2 * last > settings_.time_budget) {
            observer_.warn(
                fmt::format("the time budget of {} s ends at {} blocks, ±{:.1f} % ({}); the target was ±{:.2g} %",
                            settings_.time_budget, end, 100 * now.error, now.of, 100 * settings_.target_error));
            return;
        }
        if (2 * end > most_blocks)
            observer_.warn(fmt::format("no more than {} blocks are replayed: ±{:.1f} % ({}); the target was ±{:.2g} %",
                                       most_blocks, 100 * now.error, now.of, 100 * settings_.target_error));
    }
}

cachesim::Origin Estimator::origin(std::size_t c, std::size_t g, double error) const {
    const traces::Header& header = cases_[c].capture->header();
    const traces::Provenance& p = header.provenance;
    cachesim::Origin origin{p.scene,
                            names_[c],
                            p.sequence,
                            p.parameters,
                            p.thread_map,
                            gpus_[g].name,
                            p.spp,
                            {gpus_[g].levels.size(), gpus_[g].l1().sector_bytes},
                            {}};
    cachesim::WindowSample& w = origin.windows.emplace();
    w.blocks = blocks_;
    w.indices = cases_[c].plan.launches() * cases_[c].plan.indices_per_launch();
    w.windows = sizes_.windows;
    w.timed_windows = timed_ ? sizes_.timed_windows : 0;
    if (blocks_ > 1 && error != all_error) w.widening = cachesim::widening(blocks_ - 1, error);
    for (const auto& block : cases_[c].blocks) {
        w.unfilled_share += block[g].unfilled_share / blocks_;
        w.last_cache_full &= block[g].unfilled_share < sizes_.unfilled_share;
    }
    return origin;
}

Predicted Estimator::series(double error) const {
    Predicted all;
    for (std::size_t c = 0; c < cases_.size(); ++c)
        for (std::size_t g = 0; g < gpus_.size(); ++g) {
            cachesim::Series& counted = all.traffic.emplace_back(cachesim::Series{origin(c, g, error), {}});
            for (const auto& block : cases_[c].blocks) counted.launches.push_back(block[g].counts);
            if (!timed_) continue;
            cachesim::TimedSeries& timed = all.times.emplace_back();
            static_cast<cachesim::Origin&>(timed) = counted;
            timed.no_time = cachesim::no_time_note(gpus_[g]);
            for (const auto& block : cases_[c].blocks) timed.launches.push_back(block[g].times);
        }
    return all;
}

std::vector<Json> Estimator::subject() const {
    std::vector<Json> all;
    for (const Case& c : cases_) {
        traces::Header header = c.capture->header();
        std::set<std::uint32_t> indices;
        for (std::uint32_t i = 0; i < blocks_ * c.plan.launches(); ++i) indices.insert(header.launches[i]);
        header.launches.assign(indices.begin(), indices.end());
        all.push_back(trace_json(header, ""));
    }
    return all;
}

}  // namespace

void EstimateSettings::check() const {
    if (!(target_error > 0 && target_error <= 1))
        throw UsageError(
            fmt::format("target error {:g} %; expected more than 0 and at most 100 %", 100 * target_error));
    if (!(time_budget >= 0 && std::isfinite(time_budget)))
        throw UsageError(fmt::format("time budget {} s; expected 0 or more", time_budget));
    constexpr std::uint64_t most_windows = std::uint64_t{most_blocks} * WindowSizes{}.windows;
    if (window_count == 1 || window_count > most_windows)
        throw UsageError(fmt::format("{} window{}; expected 2 (an interval takes two) to {}", window_count,
                                     window_count == 1 ? "" : "s", most_windows));
}

bool has_windows(const LaunchSettings& launches) {
    if (launches.of_traces()) return false;
    const auto captures = launches.captures();
    return std::all_of(captures.begin(), captures.end(), [](const tracer::CaptureSettings& c) {
        return c.execution.execution == tracer::Execution::megakernel;
    });
}

Estimated estimate(const LaunchSettings& launches, const EstimateSettings& settings,
                   const std::vector<cachesim::Gpu>& gpus, bool timed, Observer& observer, const FileNames& outputs) {
    settings.check();
    launches.check();
    if (!has_windows(launches))
        throw UsageError(
            "windows of traces or wavefronts; expected a scene and --execution megakernel: the windows of an estimate "
            "are traced where they are wanted");
    warn_of_strategies(launches.captures(), observer);
    const auto scene = launches.scene.prepare(outputs, observer);
    Estimator estimator(*scene, launches, settings, gpus, timed, observer);
    estimator.run();
    Estimated out;
    for (const cachesim::Gpu& gpu : gpus) out.subject.gpus.push_back(gpu_json(gpu));
    out.subject.traces = estimator.subject();
    out.result = estimator.result();
    return out;
}

}  // namespace raycache::tools
