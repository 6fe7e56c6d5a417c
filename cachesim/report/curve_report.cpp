#include "cachesim/report/curve_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "cachesim/gpus/choice.hpp"
#include "cachesim/report/format.hpp"
#include "traces/memory_budget.hpp"

namespace raycache::cachesim {

namespace {

const CurveSeries* series_of_baseline(const CurveReport& report, const CurveSeries& of) {
    return find_baseline(report.series, of, report.baseline, [](const CurveSeries&) { return true; });
}

void find_equivalents(CurveReport& report) {
    for (const CurveSeries& other : report.series) {
        if (report.baseline.empty() || other.strategy == report.baseline) continue;
        const CurveSeries* const base = series_of_baseline(report, other);
        if (!base || base->samples != other.samples) {
            report.notes.push_back(fmt::format("{}, N {}: no {} of the same {} to be held against", other.strategy,
                                               other.spp, report.baseline,
                                               base ? "sample indices" : "scene, sequence, N and thread map"));
            continue;
        }
        for (std::size_t l = 0; l < other.levels.size(); ++l) {
            const LevelCurve &b = base->levels[l], &o = other.levels[l];
            report.equivalents.push_back({base->strategy, other.strategy, series_name(report, *base),
                                          series_name(report, other), other.spp, o.level, other.caches.levels,
                                          equivalent_size(b, o, DoesAsWell::bytes_per_ray),
                                          equivalent_size(b, o, DoesAsWell::misses), equivalent_bandwidth(b, o)});
        }
    }
}

/// "570 to 640 KiB", or nothing.
std::string interval_text(const EquivalentSize& e) {
    if (!e.low) return {};
    if (!e.high) return fmt::format("; 95 % interval from {}, without upper end", size_text(*e.low));
    return fmt::format("; 95 % interval {} to {}", size_text(*e.low), size_text(*e.high));
}

std::string text_of(const EquivalentSize& e) {
    return fmt::format("{} ({:.3g}x{})", size_text(*e.size), e.times(), interval_text(e));
}

/// One less this.
Estimate less_than_one(const Sums& sums) {
    Estimate share = ratio_of_totals(sums);
    share.mean = 1 - share.mean;
    return share;
}

}  // namespace

CurveReport make_curve_report(std::vector<CurveSeries> series, const std::string& baseline,
                              std::vector<std::uint64_t> sizes) {
    CurveReport report;
    report.series = std::move(series);
    report.baseline = baseline;
    report.sizes = std::move(sizes);
    std::sort(report.sizes.begin(), report.sizes.end());
    report.sizes.erase(std::unique(report.sizes.begin(), report.sizes.end()), report.sizes.end());
    check_baseline(report.series, baseline);
    find_equivalents(report);
    if (std::any_of(report.series.begin(), report.series.end(), [](const auto& s) { return s.samples.size() == 1; }))
        report.notes.emplace_back("one sample index: no confidence interval; raise --trace-samples");
    if (const double rate = report.series.front().levels.front().rows.front().launches.front().rate; rate < 1)
        report.notes.push_back(
            fmt::format("estimates from {:.3g} % of all lines (SHARDS), fully associative; ± knows of "
                        "sample indices alone",
                        100 * rate));
    for (const LevelCurve& level : report.series.front().levels)
        if (const std::string& policy = level.rows.front().geometry.policy; policy != "lru")
            report.notes.push_back(fmt::format("curves are of lru; {} of {} evicts by {}", level_name(level.level),
                                               report.series.front().gpu, policy));
    return report;
}

std::vector<std::uint64_t> table_sizes(const CurveReport& report, std::size_t level) {
    if (!report.sizes.empty()) return report.sizes;
    std::uint64_t most = 1;
    for (const CurveSeries& s : report.series) most = std::max(most, s.levels[level].rows.front().most_useful_ways());
    const CurveRow& own = report.series.front().levels[level].rows.front();
    std::vector<std::uint64_t> ways{own.geometry.ways};
    for (unsigned halves = 0; halves < 4 && ways.front() % 2 == 0; ++halves)
        ways.insert(ways.begin(), ways.front() / 2);
    while (ways.size() > 1 && ways.front() < own.least_ways()) ways.erase(ways.begin());
    while (ways.back() < most && ways.back() < own.geometry.ways << 20) ways.push_back(2 * ways.back());
    for (std::uint64_t& w : ways) w *= own.way_bytes();
    return ways;
}

std::vector<std::uint64_t> drawn_ways(const CurveRow& row) {
    const std::uint64_t most = row.most_useful_ways();
    std::vector<std::uint64_t> ways;
    const auto least = static_cast<double>(row.least_ways());
    for (unsigned eighth = 0;; ++eighth) {
        const auto next = std::min(most, static_cast<std::uint64_t>(std::llround(least * std::exp2(eighth / 8.0))));
        if (ways.empty() || ways.back() < next) ways.push_back(next);
        if (next == most) return ways;
    }
}

Estimate hit_rate(const LevelCurve& level, const CurveRow& row, std::uint64_t ways) {
    return less_than_one(level.misses(row, ways));
}

Estimate hit_rate(const LevelCurve& level, const PolicyRow& row, std::size_t at) {
    return less_than_one(level.misses(row, at));
}

std::string level_name(std::size_t level) { return fmt::format("L{}", level + 1); }

std::string traffic_name(std::size_t level, std::size_t levels) {
    return level + 1 == levels ? "DRAM" : fmt::format("L{}-to-L{}", level + 2, level + 1);
}

std::string row_name(const LevelCurve& level, std::size_t row) {
    const CacheGeometry &own = level.rows.front().geometry, &g = level.rows[row].geometry;
    if (g.sets * g.slices == 1) return "fully associative";
    if (row == 0) return "own sets";
    std::string name = fmt::format("{} set{}", g.sets, g.sets == 1 ? "" : "s");
    if (g.slices > 1) name += fmt::format(" in each of {} slices", g.slices);
    if (g.index != own.index) name += std::string(", ") + name_of<SetIndex>(set_indices, g.index);
    return name;
}

std::string series_name(const CurveReport& report, const CurveSeries& of) {
    std::set<std::uint64_t> ns;
    std::set<std::string> sequences;
    std::size_t alike = 0;
    for (const CurveSeries& s : report.series) {
        ns.insert(s.spp);
        sequences.insert(s.sequence);
        alike += s.strategy == of.strategy && s.sequence == of.sequence && s.spp == of.spp;
    }
    std::string name = of.strategy;
    if (alike > 1) name += " " + of.parameters;
    if (sequences.size() > 1) name += " " + of.sequence;
    if (ns.size() > 1) name += fmt::format(" N={}", of.spp);
    return name;
}

std::string to_sentence(const Equivalent& e) {
    const std::string level = level_name(e.level), own = size_text(e.bytes.of);
    std::string text =
        fmt::format("{}: {} with {} fetches as few bytes per ray as {} ", level, e.other_name, own, e.base_name);
    text += e.bytes.size ? "with " + text_of(e.bytes) : "with no size: its first touches alone are more";
    text += "; it misses as seldom as ";
    text += e.misses.size ? "with " + text_of(e.misses) : "with none";
    text += fmt::format("; with {} for both, {} needs {} times the {} bandwidth of {}", own, e.base_name,
                        with_interval(e.bandwidth, 2), traffic_name(e.level, e.levels), e.other_name);
    return text;
}

}  // namespace raycache::cachesim
