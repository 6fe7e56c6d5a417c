#include "cachesim/report/cold_launches.hpp"

#include <cmath>
#include <initializer_list>
#include <utility>

#include "cachesim/analysis/launch_factors.hpp"

namespace raycache::cachesim {
namespace {

/// With the relative interval of what it is divided by, in first order.
Estimate with_error_of(double value, const Estimate& divisor, double divisor_mean) {
    if (!divisor.half_width || !std::isfinite(value)) return {value, {}};
    const double width = std::fabs(value) * *divisor.half_width / divisor_mean;
    return {value, std::isfinite(width) ? std::optional(width) : std::nullopt};
}

double widening_of(const Origin& o) { return o.windows ? o.windows->widening : 1; }

/// Of the launches of one strategy, or none where another has others.
std::optional<Estimate> speed_up_of(const ColdLaunches& base, const ColdLaunches& own) {
    Sums of_base, of_own;
    for (const auto& [launches, sums] : {std::pair{&base, &of_base}, std::pair{&own, &of_own}})
        for (const LaunchStages& stages : launches->stages) {
            sums->y.push_back(static_cast<double>(stages.all().cycles));
            sums->x.push_back(1);
        }
    if (of_base.y.empty() || of_base.y.size() != of_own.y.size()) return std::nullopt;
    for (std::size_t i = 0; i < of_own.y.size(); ++i)
        if (base.stages[i].sample != own.stages[i].sample) return std::nullopt;
    return ratio_to_baseline(of_base, of_own);
}

ColdFigures::Time time_of(const ColdLaunches& cold, const TimedSeries& steady) {
    Sums per_access;
    for (const TimedStatistics& block : steady.launches) {
        per_access.y.push_back(static_cast<double>(block.cycles));
        per_access.x.push_back(static_cast<double>(block.warp_accesses));
    }
    const Estimate rate = widened(ratio_of_totals(per_access), widening_of(steady));
    LaunchStages sum;
    for (const LaunchStages& stages : cold.stages) sum += stages;
    const LaunchFactors f = launch_factors(sum, rate.mean);
    ColdFigures::Time time;
    time.cycles = sum.all().cycles;
    time.steady_cycles = with_error_of(f.steady_cycles, rate, rate.mean);
    time.over_steady = with_error_of(f.over_steady, rate, rate.mean);
    time.cold = with_error_of(f.cold, rate, rate.mean);
    time.ramp = {f.ramp, {}};
    time.tail = {f.tail, {}};
    time.full_share = {f.full_share, {}};
    return time;
}

/// Sectors that level `level` fetches, over warp accesses, or over rays.
Estimate fetched_per(const std::vector<LaunchStatistics>& launches, const CacheUnits& caches, std::size_t level,
                     std::uint64_t Counters::*per) {
    Sums sums;
    for (const LaunchStatistics& launch : launches) {
        const Counters all = launch.all();
        sums.y.push_back(static_cast<double>(all.fetched(level, caches.levels)));
        sums.x.push_back(static_cast<double>(all.*per));
    }
    return ratio_of_totals(sums);
}

ColdFigures::Bytes bytes_of(const ColdLaunches& cold, const Series& steady, std::size_t level) {
    const CacheUnits& caches = steady.caches;
    ColdFigures::Bytes bytes;
    const double sector = caches.sector_bytes;
    const Estimate per_ray = fetched_per(cold.launches, caches, level, &Counters::rays);
    bytes.per_ray = widened({sector * per_ray.mean, per_ray.half_width}, sector);
    if (level + 1 == caches.levels && steady.windows && !steady.windows->last_cache_full) return bytes;
    const Estimate own = fetched_per(cold.launches, caches, level, &Counters::warp_accesses);
    const Estimate rate =
        widened(fetched_per(steady.launches, caches, level, &Counters::warp_accesses), widening_of(steady));
    const double value = rate.mean > 0 ? own.mean / rate.mean : std::nan("");
    bytes.over_steady = with_error_of(value, rate, rate.mean);
    return bytes;
}

}  // namespace

std::vector<ColdFigures> cold_figures(const std::vector<ColdLaunches>& launches, const std::vector<Series>& steady,
                                      const std::vector<TimedSeries>& times, const Baseline& baseline) {
    std::vector<ColdFigures> all;
    for (std::size_t i = 0; i < launches.size(); ++i) {
        ColdFigures& figures = all.emplace_back();
        for (const LaunchStatistics& launch : launches[i].launches) figures.samples.push_back(launch.sample);
        for (std::size_t level = 0; level < steady[i].caches.levels; ++level)
            figures.bytes.push_back(bytes_of(launches[i], steady[i], level));
        if (times.empty() || launches[i].stages.empty()) continue;
        figures.time = time_of(launches[i], times[i]);
        const TimedSeries* const base =
            find_baseline(times, times[i], baseline, [](const TimedSeries&) { return true; });
        if (!base || baseline.is(times[i])) continue;
        figures.time->speed_up = speed_up_of(launches[static_cast<std::size_t>(base - times.data())], launches[i]);
    }
    return all;
}

}  // namespace raycache::cachesim
