#include "tools/bench/coverage/interval_coverage.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <cmath>
#include <numeric>

#include "cachesim/replay/replay.hpp"
#include "cachesim/replay/timed/timed_replay.hpp"
#include "cachesim/report/report.hpp"
#include "cachesim/report/timed_report.hpp"
#include "tools/jobs/windows/steady_replay.hpp"
#include "tools/jobs/windows/window_replay.hpp"
#include "tracer/sampling/random_stream.hpp"

namespace raycache::bench {
namespace {

using tools::BlockResult;

const std::vector<std::string> strategies{"cranley-patterson", "micro-jitter"};

using Captures = std::vector<std::unique_ptr<tracer::Capture>>;

/// Of all N sample indices, in order.
Captures make_captures(const CoverageSettings& s, const tracer::PreparedScene& scene) {
    Captures all;
    for (const std::string& name : strategies) {
        tracer::CaptureSettings settings =
            tools::capture_settings(s.scene, s.sampling, {tracer::parse_strategy_name(name), "sobol", s.spp, {}, {}});
        settings.first_indices.resize(s.spp);
        std::iota(settings.first_indices.begin(), settings.first_indices.end(), 0U);
        all.push_back(std::make_unique<tracer::Capture>(scene, settings));
    }
    return all;
}

template <class Replay>
auto steady_state(const tracer::Capture& capture, const cachesim::Gpu& gpu) {
    Replay replay(gpu, capture.header().regions, 0);
    const auto worker = capture.make_worker();
    const auto push = [&](std::uint32_t launch, std::uint32_t count) {
        for (std::uint32_t warp = 0; warp < count; ++warp) {
            traces::WarpTrace trace;
            capture.trace_warp(*worker, launch, warp, trace);
            replay.push(std::make_shared<const traces::WarpTrace>(std::move(trace)));
        }
    };
    tools::walk_steady(tools::extent_of(capture.settings()), tools::wave_warps(gpu),
                       {push, [&] { replay.count_from_here(); }, [&] { replay.count_until_here(); }});
    return replay.finish();
}

/// What is told of one strategy: of each block, or, once, of everything.
using Results = std::vector<BlockResult>;

struct Figure {
    std::string name;
    cachesim::Estimate estimate;
};

cachesim::Origin origin(std::size_t strategy, const cachesim::Gpu& gpu) {
    cachesim::Origin o;
    o.strategy = strategies[strategy];
    o.gpu = gpu.name;
    o.thread_map = "tile";
    o.caches = {gpu.levels.size(), gpu.l1().sector_bytes};
    return o;
}

std::vector<Figure> figures(const std::vector<Results>& by_strategy, const cachesim::Gpu& gpu, bool timed) {
    std::vector<cachesim::Series> counted;
    std::vector<cachesim::TimedSeries> times;
    for (std::size_t s = 0; s < strategies.size(); ++s) {
        counted.push_back({origin(s, gpu), {}});
        static_cast<cachesim::Origin&>(times.emplace_back()) = counted.back();
        for (const BlockResult& block : by_strategy[s]) {
            counted.back().launches.push_back(block.counts);
            for (const cachesim::TimedStatistics& time : block.times) times.back().launches.push_back(time);
        }
    }
    std::vector<Figure> all;
    const auto add = [&](const std::string& of, const std::optional<cachesim::Estimate>& estimate) {
        if (estimate) all.push_back({of, *estimate});
    };
    const cachesim::Report report = cachesim::make_report(counted, strategies[0], cachesim::GroupBy::none);
    for (std::size_t s = 0; s < strategies.size(); ++s) {
        const cachesim::Row& row = report.rows[s];
        add("steps/ray, " + strategies[s], row["steps_per_ray"]);
        add("L2->L1 B/ray, " + strategies[s], row["l2_bytes_per_ray"]);
        add("DRAM B/ray, " + strategies[s], row["dram_bytes_per_ray"]);
    }
    add("L2->L1 ratio", report.rows[1]["l2_bytes_ratio"]);
    add("DRAM ratio", report.rows[1]["dram_bytes_ratio"]);
    if (!timed) return all;
    const cachesim::TimedReport timed_report = cachesim::make_timed_report(times, strategies[0]);
    for (std::size_t s = 0; s < strategies.size(); ++s)
        add("cycles/ray, " + strategies[s], timed_report.rows[s]["cycles_per_ray"]);
    add("speed-up", timed_report.rows[1]["speed_up"]);
    return all;
}

std::vector<Results> exact(const Captures& captures, const cachesim::Gpu& gpu, bool timed, tools::Observer& observer) {
    std::vector<Results> all(captures.size(), Results(1));
    const std::size_t tasks = captures.size() * (timed ? 2 : 1);
    const tools::Stage stage(observer, "exact", tasks);
    tbb::parallel_for(
        std::size_t{0}, tasks,
        [&](std::size_t task) {
            const std::size_t s = task % captures.size();
            if (task < captures.size())
                all[s][0].counts = steady_state<cachesim::Replay>(*captures[s], gpu);
            else
                all[s][0].times = {steady_state<cachesim::TimedReplay>(*captures[s], gpu)};
            stage.add(1, 1);
        },
        tbb::simple_partitioner());
    return all;
}

/// By strategy, then block, then place in the pool.
std::vector<std::vector<Results>> make_pool(const CoverageSettings& s, const Captures& captures,
                                            const tools::WindowPlan& plan, const cachesim::Gpu& gpu,
                                            tools::Observer& observer) {
    std::vector<std::vector<Results>> all(captures.size(), std::vector<Results>(plan.blocks(), Results(s.pool)));
    const std::size_t tasks = captures.size() * plan.blocks() * s.pool;
    const tools::Stage stage(observer, "blocks", tasks);
    tools::WindowReplays replays;
    if (s.timed) replays.timed.emplace_back();
    tbb::parallel_for(
        std::size_t{0}, tasks,
        [&](std::size_t task) {
            const std::size_t number = task / captures.size(), block = number / s.pool;
            const tools::BlockPlan places = plan.block(number, static_cast<std::uint32_t>(block) * plan.launches());
            all[task % captures.size()][block][number % s.pool] =
                std::move(tools::replay_block(*captures[task % captures.size()], places.first, plan, places, s.sizes,
                                              {gpu}, replays)
                              .front());
            stage.add(1, 1);
        },
        tbb::simple_partitioner());
    return all;
}

}  // namespace

std::vector<FigureCoverage> interval_coverage(const CoverageSettings& s, tools::Observer& observer) {
    const cachesim::Gpu gpu = s.gpu.load_one({}, "coverage");
    if (s.timed) s.gpu.check_timed({gpu});
    const auto scene = s.scene.prepare({}, observer);
    const Captures captures = make_captures(s, *scene);
    const std::uint32_t warps = captures.front()->header().warps_per_launch;
    const auto plan_of = [&](std::uint64_t seed) { return tools::WindowPlan(s.spp, warps, 1, seed, s.sizes); };

    const tools::WindowPlan plan = plan_of(0);
    observer.warn(fmt::format("{} warps a launch, {} a wave of {}; {} blocks of {} sample indices", warps,
                              tools::wave_warps(gpu), gpu.name, plan.blocks(), plan.launches()));
    const auto pool = make_pool(s, captures, plan, gpu, observer);
    const std::vector<Figure> truth = figures(exact(captures, gpu, s.timed, observer), gpu, s.timed);

    std::vector<FigureCoverage> all;
    for (const Figure& figure : truth) {
        FigureCoverage& f = all.emplace_back();
        f.figure = figure.name;
        f.exact = figure.estimate.mean;
    }
    for (std::uint32_t e = 0; e < s.estimates; ++e) {
        tracer::RandomStream random(e + 1, tracer::HashPurpose::window_places);
        std::vector<Results> drawn(captures.size());
        for (const std::uint32_t first : plan_of(e + 1).draw(s.blocks)) {
            const std::uint64_t place = random.below(s.pool);
            for (std::size_t c = 0; c < captures.size(); ++c)
                drawn[c].push_back(pool[c][first / plan.launches()][place]);
        }
        const std::vector<Figure> estimated = figures(drawn, gpu, s.timed);
        for (std::size_t i = 0; i < all.size(); ++i) {
            const cachesim::Estimate& estimate = estimated[i].estimate;
            const double off = estimate.mean / all[i].exact - 1;
            const double half = *estimate.half_width / all[i].exact;
            all[i].held += (std::fabs(off) <= half ? 1.0 : 0.0) / s.estimates;
            all[i].half_width += half / s.estimates;
            all[i].error += off * off / s.estimates;
            all[i].bias += off / s.estimates;
        }
    }
    for (FigureCoverage& f : all) f.error = std::sqrt(f.error);
    return all;
}

}  // namespace raycache::bench
