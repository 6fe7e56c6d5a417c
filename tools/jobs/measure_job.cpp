#include "tools/jobs/measure_job.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>
#include <random>
#include <span>

#include "tools/jobs/costs.hpp"
#include "tools/jobs/hardware_counters.hpp"
#include "tools/jobs/timed_walk.hpp"
#include "traces/error.hpp"
#include "traces/memory_budget.hpp"
#include "traces/shuffle.hpp"

namespace raycache::tools {
namespace {

bool is_baseline(const MeasureJob& job, const CaseSettings& one) {
    return one.strategy == tracer::parse_strategy_name(job.baseline);
}

std::vector<tracer::WalkMode> modes_of(const MeasureJob& job, const tracer::EmbreeFacts& embree) {
    std::vector<tracer::WalkMode> modes;
    const unsigned widest = embree.widths.empty() ? 1 : embree.widths.back();
    for (const tracer::WalkMode& mode : tracer::walk_modes())
        if (job.modes.empty() && (mode.width == 1 || mode.width == widest)) modes.push_back(mode);
    for (const std::string& name : job.modes) {
        modes.push_back(tracer::walk_mode(name));
        if (embree.walks(modes.back())) continue;
        std::string valid;
        for (const tracer::WalkMode& other : tracer::walk_modes())
            if (embree.walks(other)) valid += (valid.empty() ? "" : ", ") + other.name;
        throw Error(
            fmt::format("mode {}: this processor (Embree uses {}) has no packets of {} rays; expected one of: {}", name,
                        embree.isa, modes.back().width, valid));
    }
    return modes;
}

/// A case, or the control of its N and sequence.
struct Strategy {
    std::string name;
    bool control;
    std::unique_ptr<tracer::Capture> capture;
};

/// The rays of one strategy and sample index in one order, and of one group.
struct LoggedRays {
    std::size_t strategy;
    std::string order, group;
    tracer::RayLog log;
};

/// Groups of rays beside "all", and how a batch finds its own.
std::string group_of(RayGroups by, const tracer::RayBatch& batch) {
    constexpr const char* types[] = {"camera", "bounce", "shadow"};
    const char* type = types[static_cast<unsigned>(batch.type)];
    if (by == RayGroups::ray) return type;
    if (by == RayGroups::bounce) return fmt::format("bounce {}", batch.bounce);
    return batch.type == traces::RayType::camera ? type : fmt::format("{} {}", type, batch.bounce);
}

/// The strategies of one N and sequence, walked together.
class Round {
public:
    Round(const MeasureJob& job, const tracer::PreparedScene& scene, const tracer::EmbreeWalker& walker,
          std::vector<Strategy> strategies, const std::vector<tracer::WalkMode>& modes)
        : job_(job),
          scene_(scene),
          walker_(walker),
          strategies_(std::move(strategies)),
          modes_(modes),
          random_(job.sampling.seed) {
        for (const Strategy& s : strategies_)
            if (s.capture->header().launches != launches())
                throw UsageError(
                    fmt::format("{} and {} trace different launches, those of other thread maps; measure them apart",
                                strategies_.front().name, s.name));
    }

    const std::vector<std::uint32_t>& launches() const { return strategies_.front().capture->header().launches; }
    const std::vector<Strategy>& strategies() const { return strategies_; }

    /// All walks of one sample index.
    void measure(std::uint32_t launch, HardwareCounters& counters, const Stage& stage) {
        MemoryBudget memory;
        const std::vector<LoggedRays> logs = log_all(launch, memory);
        std::vector<TimedWalk> walks;
        for (const LoggedRays& rays : logs)
            for (const tracer::WalkMode& mode : modes_) walks.emplace_back(rays.log, mode);
        for (std::uint32_t repetition = 0; repetition <= job_.repeats; ++repetition) {
            shuffle(walks.size());
            std::uint64_t rays = 0;
            for (const std::size_t w : order_) {
                walks[w].walk(walker_, counters, repetition == 0);
                rays += walks[w].log().rays.size();
            }
            stage.add(1, rays);
        }
        for (std::size_t w = 0; w < walks.size(); ++w) {
            const LoggedRays& rays = logs[w / modes_.size()];
            add(row_of(rays, w % modes_.size(), counters), walks[w]);
        }
        ++indices_;
    }

    /// By group, order and mode, so that strategies stand side by side.
    std::vector<MeasuredWalk> finish() {
        std::stable_sort(rows_.begin(), rows_.end(), [](const Row& a, const Row& b) { return a.place < b.place; });
        std::vector<MeasuredWalk> walks;
        for (Row& row : rows_) {
            row.walk.rays.resize(indices_);
            row.walk.seconds.resize(indices_);
            for (auto& counter : row.walk.counters) counter.resize(indices_);
            walks.push_back(std::move(row.walk));
        }
        return walks;
    }

private:
    struct Row {
        /// Group as it first came, shuffled or not, mode, strategy.
        std::array<std::size_t, 4> place;
        MeasuredWalk walk;
    };

    std::vector<LoggedRays> log_all(std::uint32_t launch, MemoryBudget& memory) {
        std::vector<LoggedRays> logs;
        const auto keep = [&](LoggedRays rays) {
            if (rays.log.rays.empty()) return;
            memory.charge(rays.log.bytes() * (job_.shuffled ? 2 : 1), scene_.scene().name,
                          "the rays of a sample index of all strategies");
            if (job_.shuffled)
                logs.push_back({rays.strategy, "shuffled", rays.group, tracer::shuffled(rays.log, job_.sampling.seed)});
            logs.push_back(std::move(rays));
            if (job_.shuffled) std::swap(logs[logs.size() - 1], logs[logs.size() - 2]);
        };
        for (std::size_t s = 0; s < strategies_.size(); ++s) {
            tracer::RayLog all = tracer::log_rays(*strategies_[s].capture, launch);
            std::vector<std::string> groups;
            if (job_.by != RayGroups::none)
                for (const tracer::RayBatch& batch : all.batches)
                    if (const std::string group = group_of(job_.by, batch);
                        std::find(groups.begin(), groups.end(), group) == groups.end())
                        groups.push_back(group);
            std::vector<tracer::RayLog> parts;
            for (const std::string& group : groups)
                parts.push_back(tracer::only(
                    all, [&](const tracer::RayBatch& batch) { return group_of(job_.by, batch) == group; }));
            keep({s, "warp", "all", std::move(all)});
            for (std::size_t g = 0; g < groups.size(); ++g) keep({s, "warp", groups[g], std::move(parts[g])});
        }
        return logs;
    }

    void shuffle(std::size_t walks) {
        order_.resize(walks);
        for (std::size_t i = 0; i < walks; ++i) order_[i] = i;
        shuffle_by(order_, [&](std::size_t n) { return random_() % n; });
    }

    MeasuredWalk& row_of(const LoggedRays& rays, std::size_t mode, const HardwareCounters& counters) {
        const auto group = std::find(groups_.begin(), groups_.end(), rays.group);
        const std::array place{static_cast<std::size_t>(group - groups_.begin()), std::size_t{rays.order == "shuffled"},
                               mode, rays.strategy};
        if (group == groups_.end()) groups_.push_back(rays.group);
        for (Row& row : rows_)
            if (row.place == place) return row.walk;
        const Strategy& strategy = strategies_[rays.strategy];
        const traces::Provenance& p = strategy.capture->header().provenance;
        MeasuredWalk walk;
        walk.strategy = strategy.name;
        walk.sequence = p.sequence;
        walk.parameters = p.parameters;
        walk.thread_map = p.thread_map;
        walk.spp = p.spp;
        walk.seed = p.seed;
        walk.control = strategy.control;
        walk.mode = modes_[mode].name;
        walk.order = rays.order;
        walk.group = rays.group;
        walk.counters.resize(counters.names().size());
        rows_.push_back({place, std::move(walk)});
        return rows_.back().walk;
    }

    void add(MeasuredWalk& row, const TimedWalk& walk) const {
        row.rays.resize(indices_);
        row.seconds.resize(indices_);
        row.rays.push_back(static_cast<double>(walk.log().rays.size()));
        row.seconds.push_back(walk.seconds());
        for (std::size_t c = 0; c < row.counters.size(); ++c) {
            row.counters[c].resize(indices_);
            row.counters[c].push_back(walk.counter(c));
        }
        row.other_ends += walk.other_ends();
    }

    const MeasureJob& job_;
    const tracer::PreparedScene& scene_;
    const tracer::EmbreeWalker& walker_;
    std::vector<Strategy> strategies_;
    const std::vector<tracer::WalkMode>& modes_;
    std::mt19937_64 random_;
    std::vector<std::size_t> order_;
    std::vector<std::string> groups_;
    std::vector<Row> rows_;
    std::size_t indices_ = 0;  ///< measured so far
};

/// The cases of one N and sequence, and the control: the baseline with the next seed, its sample indices those of the
/// baseline.
std::vector<Strategy> strategies_of(const MeasureJob& job, const tracer::PreparedScene& scene,
                                    std::span<const CaseSettings> cases) {
    std::vector<Strategy> all;
    for (const CaseSettings& one : cases)
        all.push_back({to_string(one.strategy), false,
                       std::make_unique<tracer::Capture>(scene, capture_settings(job.scene, job.sampling, one))});
    const auto base = std::find_if(cases.begin(), cases.end(), [&](const auto& one) { return is_baseline(job, one); });
    SamplingSettings other = job.sampling;
    ++other.seed;
    tracer::CaptureSettings control = capture_settings(job.scene, other, *base);
    control.first_indices = all[static_cast<std::size_t>(base - cases.begin())].capture->header().launches;
    all.push_back({to_string(base->strategy), true, std::make_unique<tracer::Capture>(scene, control)});
    return all;
}

}  // namespace

void MeasureJob::check() const {
    if (repeats == 0) throw UsageError("repeats 0; expected at least 1");
    if (cases.empty()) throw UsageError("no strategy to measure; expected at least one");
    for (const std::string& mode : modes) tracer::walk_mode(mode);
    for (const CaseSettings& one : cases)
        if (std::none_of(cases.begin(), cases.end(), [&](const CaseSettings& other) {
                return other.spp == one.spp && other.sequence == one.sequence && is_baseline(*this, other);
            }))
            throw UsageError(
                fmt::format("baseline '{}' is none of the strategies; expected one of --strategy", baseline));
    for (const tracer::CaptureSettings& settings : capture_settings(scene, sampling, cases)) {
        if (settings.execution.execution == tracer::Execution::wavefront)
            throw UsageError("a wavefront cannot be measured: rays are logged as a megakernel's warps start them");
        if (!tracer::integrator_entry(settings.paths.integrator).walks_bvh)
            throw UsageError(
                fmt::format("integrator {} cannot be measured: it sends no ray through a BVH that Embree could walk; "
                            "expected another --integrator",
                            settings.paths.integrator));
    }
}

MeasureResult run(const MeasureJob& job, Observer& observer, const FileNames& outputs) {
    job.check();
    MeasureResult result;
    result.embree = tracer::embree_facts();
    const std::vector<tracer::WalkMode> modes = modes_of(job, result.embree);
    HardwareCounters counters;
    result.machine = this_machine();
    result.counters = counters.names();
    result.baseline = job.baseline;
    result.repeats = job.repeats;

    double seconds = 0;
    const auto captures = capture_settings(job.scene, job.sampling, job.cases);
    for (const auto& settings : captures)
        seconds += trace_cost(settings) * (1 + (job.repeats + 1.0) * static_cast<double>(modes.size()) *
                                                   (job.shuffled ? 2 : 1) * (job.by == RayGroups::none ? 1 : 2));
    observer.expect("measure", Work::render, seconds);
    warn_of_strategies(captures, observer);
    const auto scene = job.scene.prepare(outputs, observer);
    result.scene = scene->scene().name;
    scene->scene().charge(scene->scene().triangle_count() * tracer::EmbreeWalker::triangle_bytes,
                          "Embree's BVH of its triangles");
    const tracer::EmbreeWalker walker(scene->scene(), scene->texels());

    // Neighbours in the list of cases have N and sequence in common.
    std::vector<std::unique_ptr<Round>> rounds;
    std::uint64_t work = 0;
    for (std::size_t first = 0, end = 0; first < job.cases.size(); first = end) {
        const auto same = [&](const CaseSettings& c) {
            return c.spp == job.cases[first].spp && c.sequence == job.cases[first].sequence;
        };
        while (end < job.cases.size() && same(job.cases[end])) ++end;
        rounds.push_back(std::make_unique<Round>(
            job, *scene, walker, strategies_of(job, *scene, std::span(job.cases).subspan(first, end - first)), modes));
        work += rounds.back()->launches().size() * (job.repeats + 1);
    }
    {
        const Stage stage(observer, "measure", work, "rays");
        for (const auto& round : rounds)
            for (std::uint32_t launch = 0; launch < round->launches().size(); ++launch)
                round->measure(launch, counters, stage);
    }
    for (const auto& round : rounds) {
        for (MeasuredWalk& walk : round->finish()) result.walks.push_back(std::move(walk));
        for (const Strategy& strategy : round->strategies())
            result.subject.traces.push_back(trace_json(strategy.capture->header(), ""));
    }
    return result;
}

}  // namespace raycache::tools
