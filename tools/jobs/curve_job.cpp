#include "tools/jobs/curve_job.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>
#include <numeric>
#include <optional>

#include "cachesim/analysis/belady.hpp"
#include "cachesim/cache/registry.hpp"
#include "cachesim/replay/replay.hpp"
#include "tools/jobs/costs.hpp"
#include "tools/jobs/replay_with.hpp"
#include "traces/error.hpp"
#include "traces/memory_budget.hpp"

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
    if (job.rate < 1) {
        std::vector<cachesim::CacheGeometry> whole{cachesim::fully_associative(own)};
        whole.front().ways = own.lines();
        return whole;
    }
    std::vector<cachesim::CacheGeometry> rows{own};
    if (own.sets * own.slices != 1) rows.push_back(cachesim::fully_associative(own));
    for (const std::uint64_t sets : job.sets)
        if (sets != own.sets && sets * own.slices != 1) rows.push_back(cachesim::with_sets(own, sets));
    return rows;
}

/// Of the caches with other policies: `sizes`, or a few around the GPU's own.
std::vector<std::uint64_t> ways_of_policies(const CurveJob& job, const cachesim::CacheGeometry& own) {
    std::vector<std::uint64_t> ways;
    for (const std::uint64_t size : job.sizes) ways.push_back(size / own.way_bytes());
    if (ways.empty())
        for (const unsigned quarters : {1, 2, 4, 8, 16})
            if (own.ways * quarters % 4 == 0) ways.push_back(own.ways * quarters / 4);
    std::sort(ways.begin(), ways.end());
    ways.erase(std::unique(ways.begin(), ways.end()), ways.end());
    return ways;
}

constexpr const char* optimum = "belady";
constexpr std::uint64_t fewest_followed = 1024;  ///< lines of a sample

/// What listens to one level of one launch.
class LevelListeners {
public:
    LevelListeners(const CurveJob& job, const cachesim::Gpu& gpu, const std::vector<traces::Region>& regions,
                   std::size_t level, cachesim::Replay& replay)
        : own_(gpu.levels[level]), ways_(ways_of_policies(job, own_)), surface_(level, rows_of(job, own_), job.rate) {
        replay.observe(surface_);
        std::vector<cachesim::CacheGeometry> geometries;
        for (const std::string& policy : job.policies) {
            if (policy == optimum) {
                replay.observe(belady_.emplace(level));
                continue;
            }
            for (const std::uint64_t ways : ways_) {
                geometries.push_back(own_);
                geometries.back().policy = policy;
                geometries.back().ways = ways;
            }
        }
        if (!geometries.empty()) replay.observe(others_.emplace(gpu, regions, level, geometries));
    }

    const cachesim::LruSurface& surface() const { return surface_; }

    /// By policy, in the order of the job, and ways.
    std::vector<std::vector<cachesim::PolicyCounts>> policies(const CurveJob& job) const {
        std::vector<std::vector<cachesim::PolicyCounts>> all;
        std::vector<cachesim::PolicyCounts> others;
        if (others_) others = others_->counts();
        std::size_t next = 0;
        for (const std::string& policy : job.policies) {
            auto& of_policy = all.emplace_back();
            for (const std::uint64_t ways : ways_) {
                cachesim::CacheGeometry geometry = own_;
                geometry.ways = ways;
                of_policy.push_back(policy == optimum ? belady_->counts(geometry) : others[next++]);
            }
        }
        return all;
    }

private:
    cachesim::CacheGeometry own_;
    std::vector<std::uint64_t> ways_;
    cachesim::LruSurface surface_;
    std::optional<cachesim::PolicyCaches> others_;
    std::optional<cachesim::BeladyCaches> belady_;
};

/// What one launch says of all levels.
struct LaunchCurves {
    double rays = 0;
    std::vector<std::vector<cachesim::WaysCurve>> curves;                    ///< by level, by row
    std::vector<std::vector<std::vector<cachesim::PolicyCounts>>> policies;  ///< by level, policy, ways
    std::vector<double> asked;                                               ///< by level
    std::vector<std::uint64_t> look_ups;
    std::uint64_t memory_bytes = 0;
};

/// A replay of one launch, and its listeners.
class CurveReplay {
public:
    CurveReplay(const CurveJob& job, const cachesim::Gpu& gpu, const std::vector<traces::Region>& regions,
                std::uint32_t sample)
        : job_(job), levels_(levels_of(job, gpu)), sample_(sample), replay_(gpu, regions, sample) {
        for (const std::size_t level : levels_)
            listeners_.push_back(std::make_unique<LevelListeners>(job, gpu, regions, level, replay_));
    }

    void push(const std::shared_ptr<const traces::WarpTrace>& warp) { replay_.push(warp); }
    void end_kernel() { replay_.end_kernel(); }
    LaunchCurves finish() {
        const cachesim::Counters all = replay_.finish().all();
        LaunchCurves result;
        result.rays = static_cast<double>(all.rays);
        for (std::size_t l = 0; l < levels_.size(); ++l) {
            const cachesim::LruSurface& surface = listeners_[l]->surface();
            if (job_.rate < 1 && surface.lines() < fewest_followed)
                throw UsageError(
                    fmt::format("--sampled {}: expected a sample of at least {} lines, found {} of sample index {}; "
                                "raise it, or leave it out: the exact curve of so few lines is quick",
                                job_.rate, fewest_followed, surface.lines(), sample_));
            result.curves.push_back(surface.curves());
            result.policies.push_back(listeners_[l]->policies(job_));
            result.asked.push_back(
                static_cast<double>(levels_[l] == 0 ? all.requests : all.levels[levels_[l]].sectors));
            result.look_ups.push_back(surface.look_ups());
            result.memory_bytes += surface.bytes();
        }
        return result;
    }

private:
    const CurveJob& job_;
    std::vector<std::size_t> levels_;
    std::uint32_t sample_;
    cachesim::Replay replay_;
    std::vector<std::unique_ptr<LevelListeners>> listeners_;  ///< by level; must not move
};

struct CurvedSeries : cachesim::Origin {
    std::vector<LaunchCurves> launches;
};

}  // namespace

std::vector<std::string> CurveJob::policy_names() {
    std::vector<std::string> names = cachesim::cache_policies();
    names.insert(names.begin(), optimum);
    return names;
}

void CurveJob::check(const cachesim::Gpu& loaded) const {
    launches.check();
    const auto names = policy_names();
    for (const std::string& policy : policies)
        if (std::find(names.begin(), names.end(), policy) == names.end())
            throw UsageError(fmt::format("policy '{}'; expected one of: {}", policy, fmt::join(names, ", ")));
    for (const std::size_t level : levels)
        if (level >= loaded.levels.size())
            throw UsageError(fmt::format("level l{}; expected l1 to l{}, the levels of {}", level + 1,
                                         loaded.levels.size(), loaded.name));
    if (rate <= 0 || rate > 1) throw UsageError(fmt::format("rate {}; expected above 0, at most 1", rate));
    if (rate < 1) {
        if (!sets.empty() || !policies.empty())
            throw UsageError("sets or policies beside a sampled curve; expected neither: it is of full associativity");
        for (const std::size_t l : levels_of(*this, loaded))
            if (const std::uint64_t lines = loaded.levels[l].lines(); lines < cachesim::WaysCurve::fewest_sampled_lines)
                throw UsageError(fmt::format(
                    "--sampled for {} of {}, of {} lines; expected a level of at least {}: "
                    "samples say nothing of smaller caches",
                    cachesim::level_name(l), loaded.name, lines, cachesim::WaysCurve::fewest_sampled_lines));
    }
    if (sizes.empty()) return;
    if (levels.size() != 1) throw UsageError("sizes of all levels; expected those of one, such as --level l1");
    const cachesim::CacheGeometry& own = loaded.levels[levels.front()];
    const std::uint64_t way = rate < 1 ? own.line_bytes : own.way_bytes();
    for (const std::uint64_t size : sizes) {
        if (rate < 1 && size / way < cachesim::WaysCurve::fewest_sampled_lines)
            throw UsageError(fmt::format("--sizes {} bytes: expected at least {} lines beside --sampled", size,
                                         cachesim::WaysCurve::fewest_sampled_lines));
        if (size % way == 0) continue;
        const std::uint64_t below = size / way * way;
        throw UsageError(
            fmt::format("--sizes {} bytes: expected a whole number of ways of {} of the {} of {}; the nearest {}", size,
                        size_text(way), cachesim::level_name(levels.front()), loaded.name,
                        below == 0 ? "is " + size_text(way)
                                   : fmt::format("are {} and {}", size_text(below), size_text(below + way))));
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
    for (std::size_t s = 0; s < sources.size(); ++s) refuse_wavefront(*sources[s].header, launches.names()[s], "curve");
    std::vector<CurvedSeries> found =
        replay_with<CurvedSeries>(sources, {gpu}, observer,
                                  [&](const cachesim::Gpu& of, const std::vector<traces::Region>& regions,
                                      std::uint32_t sample) { return CurveReplay(job, of, regions, sample); });
    CurveResult result{{{gpu_json(gpu)}, launches.subject()}, {}};
    const auto levels = levels_of(job, gpu);
    for (std::size_t s = 0; s < sources.size(); ++s) {
        cachesim::CurveSeries& series = result.series.emplace_back();
        static_cast<cachesim::Origin&>(series) = found[s];
        series.samples = sources[s].header->launches;
        for (std::size_t l = 0; l < levels.size(); ++l) {
            cachesim::LevelCurve& level = series.levels.emplace_back();
            level.level = levels[l];
            for (const cachesim::CacheGeometry& row : rows_of(job, gpu.levels[levels[l]]))
                level.rows.push_back({row, {}});
            for (const std::string& policy : job.policies)
                level.policies.push_back({policy, ways_of_policies(job, gpu.levels[levels[l]]), {}});
            for (LaunchCurves& launch : found[s].launches) {
                level.rays.push_back(launch.rays);
                level.asked.push_back(launch.asked[l]);
                level.look_ups += launch.look_ups[l];
                for (std::size_t r = 0; r < level.rows.size(); ++r)
                    level.rows[r].launches.push_back(std::move(launch.curves[l][r]));
                for (std::size_t i = 0; i < level.policies.size(); ++i)
                    level.policies[i].launches.push_back(std::move(launch.policies[l][i]));
            }
        }
        for (const LaunchCurves& launch : found[s].launches)
            series.memory_bytes = std::max(series.memory_bytes, launch.memory_bytes);
    }
    return result;
}

}  // namespace raycache::tools
