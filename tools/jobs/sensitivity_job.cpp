#include "tools/jobs/sensitivity_job.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>

#include "cachesim/replay/launch_checks.hpp"
#include "tools/jobs/baseline.hpp"
#include "tools/jobs/costs.hpp"
#include "tools/jobs/gpu_variants.hpp"
#include "tools/jobs/replay_launches.hpp"
#include "tools/jobs/sensitivity/timed_sample.hpp"
#include "tools/jobs/windows/estimate.hpp"
#include "traces/error.hpp"

namespace raycache::tools {
namespace {

using cachesim::TimedSums;

/// By case, GPU and model.
using AllSums = std::vector<std::vector<std::vector<TimedSums>>>;

AllSums empty_sums(std::size_t cases, const std::vector<VariedGpu>& gpus) {
    AllSums sums(cases);
    for (auto& of_case : sums)
        for (const VariedGpu& gpu : gpus) of_case.emplace_back(gpu.models().size());
    return sums;
}

void add_sums(TimedSums& sums, const cachesim::TimedStatistics& t) {
    sums.cycles.push_back(static_cast<double>(t.cycles));
    sums.rays.push_back(static_cast<double>(t.rays));
}

/// What windows there are: one in time of each block.
WindowSizes sizes_of_windows() {
    WindowSizes sizes;
    sizes.windows = sizes.timed_windows = 1;
    return sizes;
}

/// Models of all GPUs, and where each belongs.
struct Replays {
    std::vector<ModelledGpu> models;
    std::vector<std::pair<std::size_t, std::size_t>> places;  ///< GPU, model
    std::uint64_t warps = 0;

    /// `varied`: all models, else those of the files alone.
    Replays(const std::vector<VariedGpu>& gpus, bool varied, const WindowSizes& sizes) {
        for (std::size_t g = 0; g < gpus.size(); ++g)
            for (std::size_t m = 0; m < (varied ? gpus[g].models().size() : 1); ++m) {
                models.push_back(gpus[g].models()[m]);
                places.emplace_back(g, m);
                warps += TimedSample::warps_of(models.back(), sizes);
            }
    }
};

AllSums replay_sample(const SensitivityJob& job, const std::vector<WindowedCase>& cases,
                      const std::vector<VariedGpu>& gpus, Observer& observer) {
    const WindowSizes sizes = sizes_of_windows();
    const Replays of_files(gpus, false, sizes), all(gpus, true, sizes);
    const std::uint64_t warps =
        cases.size() * (job.varied_windows * all.warps + (job.windows - job.varied_windows) * of_files.warps);
    const double paths = traces::warp_lanes * static_cast<double>(warps);
    observer.expect("replays", Work::timed_replay, window_cost(job.launches.sampling.bounces, 0, 0, paths));
    const Stage stage(observer, "replays", warps, "warps");
    AllSums sums = empty_sums(cases.size(), gpus);
    for (std::uint32_t b = 0; b < job.windows; ++b)
        for (std::size_t c = 0; c < cases.size(); ++c) {
            const Replays& replays = b < job.varied_windows ? all : of_files;
            const BlockPlan plan = cases[c].plan.block(b, cases[c].first[b]);
            const TimedSample sample(cases[c], b, plan, sizes, replays.models);
            std::vector<cachesim::TimedStatistics> times(replays.models.size());
            tbb::parallel_for(
                std::size_t{0}, times.size(),
                [&](std::size_t r) {
                    times[r] = sample.replay(replays.models[r]);
                    stage.add(TimedSample::warps_of(replays.models[r], sizes),
                              TimedSample::warps_of(replays.models[r], sizes));
                },
                tbb::simple_partitioner());
            for (std::size_t r = 0; r < times.size(); ++r) {
                const auto& [g, m] = replays.places[r];
                add_sums(sums[c][g][m], times[r]);
            }
        }
    return sums;
}

AllSums replay_whole(const std::vector<LaunchSource>& sources, const std::vector<VariedGpu>& gpus, Observer& observer) {
    std::vector<cachesim::Gpu> models;
    for (const VariedGpu& gpu : gpus)
        for (const ModelledGpu& model : gpu.models()) models.push_back(model.gpu);
    const auto series = replay_timed(sources, models, observer);
    AllSums sums = empty_sums(sources.size(), gpus);
    std::size_t next = 0;
    for (auto& of_case : sums)
        for (auto& of_gpu : of_case)
            for (TimedSums& of_model : of_gpu)
                for (const auto& launch : series[next++].launches) add_sums(of_model, launch);
    return sums;
}

/// The first so many of the blocks.
TimedSums first_of(const TimedSums& sums, std::size_t count) {
    const auto cut = [&](const std::vector<double>& all) {
        return std::vector<double>(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count));
    };
    return {cut(sums.cycles), cut(sums.rays)};
}

/// `base`, `other`: by model.
cachesim::Sensitivity sensitivity_of(const VariedGpu& gpu, const std::vector<TimedSums>& base,
                                     const std::vector<TimedSums>& other) {
    cachesim::Sensitivity row;
    row.gpu = gpu.gpu().name;
    row.open = gpu.open();
    row.unread = gpu.unread();
    row.per_index = cachesim::speed_up_per_index(base.front(), other.front());
    row.per_ray = cachesim::speed_up_per_ray(base.front(), other.front());
    const auto add_points = [&](const std::vector<VariedGpu::Point>& points, std::vector<cachesim::VariedPoint>& to) {
        for (const VariedGpu::Point& p : points) {
            const std::size_t blocks = base[p.model].cycles.size();
            if (p.model == gpu.reference()) {
                to.push_back({p.values, {1, 0.0}, row.per_index, row.per_ray});
                continue;
            }
            const bool whole = !gpu.is_scaled() && blocks == base.front().cycles.size();
            to.push_back(cachesim::varied_point(p.values, base[p.model], other[p.model],
                                                first_of(base[gpu.reference()], blocks),
                                                first_of(other[gpu.reference()], blocks), row, whole));
        }
    };
    add_points(gpu.one_by_one(), row.one_by_one);
    add_points(gpu.hypercube(), row.hypercube);
    return row;
}

/// What baseline_strategy() looks at.
struct Named {
    std::string strategy;
};

std::size_t baseline_among(const std::vector<Named>& names, const std::string& asked) {
    const std::string baseline = baseline_strategy(names, asked);
    const auto found = std::find_if(names.begin(), names.end(), [&](const Named& n) { return n.strategy == baseline; });
    if (found == names.end())
        throw UsageError(
            fmt::format("baseline '{}'; expected one of the strategies", asked.empty() ? "cranley-patterson" : asked));
    return static_cast<std::size_t>(found - names.begin());
}

}  // namespace

void SensitivityJob::check() const {
    launches.check();
    if (launches.of_traces()) throw UsageError("traces; expected a scene: a trace is not replayed in windows");
    if (gpus.empty()) throw UsageError("no GPU; expected at least one");
    if (launches.cases.size() < 2) throw UsageError("one strategy; expected a baseline and at least another");
    for (const std::string& name : gpus)
        if (std::count(gpus.begin(), gpus.end(), name) > 1)
            throw UsageError(fmt::format("--gpu: expected each GPU once, found {} twice", name));
    for (const std::string& change : changes)
        if (listed_changes(change).size() != 1)
            throw UsageError(
                fmt::format("--set {}: expected one value, which is then not varied, found several", change));
    if (whole_launches) {
        if (variations.sms != 0)
            throw UsageError("--sms with whole launches; expected windows: a part of a GPU has none");
        return;
    }
    if (!has_windows(launches))
        throw UsageError(
            "windows of a wavefront; expected --execution megakernel, or --trace-samples for whole launches");
    if (windows < 2 || varied_windows < 2 || varied_windows > windows)
        throw UsageError(
            fmt::format("{} windows, {} of them varied; expected at least 2 (an interval takes two), and no "
                        "more varied than there are",
                        windows, varied_windows));
}

SensitivityResult run(const SensitivityJob& job, Observer& observer) {
    job.check();
    std::vector<VariedGpu> gpus;
    for (const std::string& name : job.gpus) {
        const cachesim::Gpu& gpu = gpus.emplace_back(name, job.changes).gpu();
        cachesim::checked_timed(gpu);
        if (const std::string note = cachesim::no_time_note(gpu); !note.empty()) throw UsageError(note);
    }
    observer.resumable("nothing can be resumed: run the same command again, with fewer windows or --samples");
    SensitivityResult result;
    for (const VariedGpu& gpu : gpus) result.subject.gpus.push_back(gpu_json(gpu.gpu()));
    std::vector<Named> names;
    AllSums sums;
    std::vector<traces::Region> regions;
    std::size_t base = 0;
    const auto vary = [&] {
        base = baseline_among(names, job.baseline);
        for (VariedGpu& gpu : gpus) gpu.vary(regions, job.variations);
    };
    const auto add_regions = [&](const traces::Header& header) {
        for (const traces::Region& region : header.regions) {  // what is read of a GPU depends on no more of it
            regions.emplace_back().kind = region.kind;
            regions.back().degree = region.degree;
        }
    };
    if (job.whole_launches) {
        const Launches launches(job.launches, {}, observer);
        for (const LaunchSource& source : launches.sources()) {
            add_regions(*source.header);
            names.push_back({to_string(source.strategy)});
        }
        vary();
        sums = replay_whole(launches.sources(), gpus, observer);
        result.subject.traces = launches.subject();
    } else {
        warn_of_strategies(job.launches.captures(), observer);
        const auto scene = job.launches.scene.prepare({}, observer);
        std::vector<WindowedCase> cases;
        const std::vector<WindowedStrategy> strategies = strategies_of(job.launches);
        const std::uint32_t grain = common_indices(strategies);
        for (const WindowedStrategy& strategy : strategies) {
            const WindowedCase& c =
                cases.emplace_back(make_case(*scene, strategy, sizes_of_windows(), 0, job.windows, grain));
            add_regions(c.capture->header());
            names.push_back({c.name});
            result.subject.traces.push_back(c.subject(job.windows));
        }
        vary();
        sums = replay_sample(job, cases, gpus, observer);
    }
    for (std::size_t g = 0; g < gpus.size(); ++g)
        for (std::size_t c = 0; c < names.size(); ++c) {
            if (c == base) continue;
            cachesim::Sensitivity& row = result.rows.emplace_back(sensitivity_of(gpus[g], sums[base][g], sums[c][g]));
            row.strategy = names[c].strategy;
            row.baseline = names[base].strategy;
        }
    return result;
}

}  // namespace raycache::tools
