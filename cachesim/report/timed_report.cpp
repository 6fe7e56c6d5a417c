#include "cachesim/report/timed_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <span>
#include <string_view>
#include <tuple>

#include "cachesim/report/csv_field.hpp"
#include "cachesim/report/estimate.hpp"
#include "cachesim/report/pairing.hpp"
#include "cachesim/report/table.hpp"
#include "traces/error.hpp"

namespace raycache::cachesim {

namespace {

struct Named {
    const char* name;
    TimedStatistics::Resource TimedStatistics::*resource;
};
/// What may bind a launch.
constexpr Named resources[] = {{"issue", &TimedStatistics::issue},
                               {"L1 port", &TimedStatistics::l1_port},
                               {"crossbar", &TimedStatistics::crossbar},
                               {"L2 slices", &TimedStatistics::l2_slices},
                               {"DRAM", &TimedStatistics::dram}};
/// Parts of these, and the registers for misses.
constexpr Named parts[] = {{"L1 tags", &TimedStatistics::l1_tags},
                           {"L1 data", &TimedStatistics::l1_data},
                           {"L1 MSHRs", &TimedStatistics::l1_mshrs},
                           {"L2 MSHRs", &TimedStatistics::l2_mshrs}};

/// The level that all SMs share.
const LevelAnswers& shared_level(const TimedStatistics& t) { return t.l3.requests() ? t.l3 : t.l2; }

TimedStatistics sum_of(const std::vector<TimedStatistics>& launches) {
    TimedStatistics sum;
    for (const TimedStatistics& launch : launches) sum += launch;
    return sum;
}

double ratio(double a, double b) { return b == 0 ? std::nan("") : a / b; }

double utilisation(const TimedStatistics& t, TimedStatistics::Resource r) {
    return ratio(r.busy, static_cast<double>(r.copies) * static_cast<double>(t.cycles));
}

double hit_rate(const LevelAnswers& a, bool merges_hit) {
    return ratio(static_cast<double>(a.hits + (merges_hit ? a.merges : 0)), static_cast<double>(a.requests()));
}

double gigabytes_per_second(const TimedRow& row, std::uint64_t sectors) {
    return ratio(static_cast<double>(sectors) * row.series.sector_bytes / 1e9, row.totals.seconds);
}
double l2_gb_s(const TimedRow& row) { return gigabytes_per_second(row, shared_level(row.totals).requests()); }
double dram_gb_s(const TimedRow& row) { return gigabytes_per_second(row, row.totals.dram_sectors); }
double visit_latency(const TimedStatistics& t) {
    return ratio(static_cast<double>(t.visit_cycles), static_cast<double>(t.warp_accesses));
}

Sums cycles_over_rays(const TimedSeries& series) {
    Sums sums;
    for (const TimedStatistics& t : series.launches) {
        sums.y.push_back(static_cast<double>(t.cycles));
        sums.x.push_back(static_cast<double>(t.rays));
    }
    return sums;
}
Sums cycles(const TimedSeries& series) {
    Sums sums = cycles_over_rays(series);
    std::fill(sums.x.begin(), sums.x.end(), 1.0);
    return sums;
}

bool comparable(const TimedSeries& a, const TimedSeries& b) {
    const auto key = [](const TimedSeries& s) { return std::tie(s.scene, s.sequence, s.spp, s.gpu); };
    return key(a) == key(b) && same_work_per_launch(a.thread_map, b.thread_map);
}

std::vector<std::uint32_t> samples(const TimedSeries& s) {
    std::vector<std::uint32_t> all;
    for (const TimedStatistics& t : s.launches) all.push_back(t.sample);
    return all;
}

std::string decimals(double value, int digits) {
    return std::isfinite(value) ? fmt::format("{:.{}f}", value, digits) : "-";
}
std::string percent(double share) { return decimals(100 * share, 1); }
std::string with_interval(const std::optional<Estimate>& e, int digits) {
    if (!e) return "-";
    return decimals(e->mean, digits) + (e->half_width ? " ±" + decimals(*e->half_width, digits) : "");
}

nlohmann::ordered_json json_of(double value) {
    return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json();
}
nlohmann::ordered_json json_of(const std::optional<Estimate>& e) {
    if (!e) return {};
    nlohmann::ordered_json out{{"mean", json_of(e->mean)}, {"half_width", nullptr}};
    if (e->half_width) out["half_width"] = json_of(*e->half_width);
    return out;
}
nlohmann::ordered_json json_of(const LevelAnswers& a) {
    return {{"requests", a.requests()},
            {"hits", a.hits},
            {"merges", a.merges},
            {"line_misses", a.line_misses},
            {"sector_misses", a.sector_misses},
            {"hit_rate_merges_hit", json_of(hit_rate(a, true))},
            {"hit_rate_merges_miss", json_of(hit_rate(a, false))}};
}

}  // namespace

TimedReport make_timed_report(const std::vector<TimedSeries>& all, const std::string& baseline) {
    TimedReport report;
    report.baseline = baseline;
    if (!baseline.empty() &&
        std::none_of(all.begin(), all.end(), [&](const TimedSeries& s) { return s.strategy == baseline; })) {
        std::set<std::string> names;
        for (const TimedSeries& s : all) names.insert(s.strategy);
        throw UsageError(
            fmt::format("baseline: expected one of the strategies {}, found \"{}\"", fmt::join(names, ", "), baseline));
    }
    for (const TimedSeries& series : all) {
        TimedRow row;
        row.series = series;
        row.totals = sum_of(series.launches);
        row.cycles_per_ray = ratio_of_totals(cycles_over_rays(series));
        for (const Named& r : resources) {
            const double share = utilisation(row.totals, row.totals.*r.resource);
            if (share > row.bottleneck_share) {
                row.bottleneck_share = share;
                row.bottleneck = r.name;
            }
        }
        if (row.bottleneck_share < 0.5) row.bottleneck = fmt::format("latency; busiest: {}", row.bottleneck);
        constexpr double few = 0.5;
        const double waves =
            ratio(static_cast<double>(row.totals.warps) / std::max<std::size_t>(1, series.launches.size()),
                  static_cast<double>(row.totals.warp_slots));
        if (row.totals.occupancy() < few && row.totals.warps)
            report.notes.push_back(fmt::format(
                "{}, N {}, {}: warps take {} % of the slots on average ({} waves a launch), so cycles are those of the "
                "longest warps rather than throughput; trace more pixels, or model fewer SMs (--set sms=...)",
                series.strategy, series.spp, series.gpu, percent(row.totals.occupancy()), decimals(waves, 2)));
        const auto find_base = [&](bool same_map) {
            return std::find_if(all.begin(), all.end(), [&](const TimedSeries& s) {
                return s.strategy == baseline && comparable(s, series) &&
                       (!same_map || s.thread_map == series.thread_map);
            });
        };
        auto base = find_base(true);
        if (base == all.end()) base = find_base(false);
        if (base != all.end() && series.strategy != baseline) {
            if (samples(*base) == samples(series)) {
                row.speed_up = ratio_to_baseline(cycles(*base), cycles(series));
            } else {
                report.notes.push_back(
                    fmt::format("no speed-up for strategy {}, N {}: its sample indices are not those "
                                "of the baseline {}",
                                series.strategy, series.spp, baseline));
            }
        }
        report.rows.push_back(std::move(row));
    }
    return report;
}

std::string to_text(const TimedReport& report) {
    using Align = TextTable::Align;
    const bool three = std::any_of(report.rows.begin(), report.rows.end(),
                                   [](const TimedRow& row) { return row.totals.l3.requests() > 0; });
    TextTable times, hits, use, rates;
    for (TextTable* table : {&times, &hits, &use, &rates}) {
        table->column("strategy", Align::left);
        table->column("N", Align::right);
        table->column("GPU", Align::left);
    }
    for (const char* title : {"cycles", "ms", "cycles/ray", "speed-up", "occupancy %"})
        times.column(title, Align::right);
    times.column("bottleneck", Align::left);
    for (const char* level : {"L1", "L2", "L3"}) {
        if (!three && std::string_view(level) == "L3") break;
        hits.column(fmt::format("{} hit %", level), Align::right);
        hits.column("(merges miss)", Align::right);
    }
    hits.column("DRAM sectors", Align::right);
    for (const Named& r : resources) use.column(fmt::format("{} %", r.name), Align::right);
    for (const Named& r : parts) use.column(fmt::format("{} %", r.name), Align::right);
    for (const char* title : {"L2 GB/s", "peak", "DRAM GB/s", "peak", "visit latency"})
        rates.column(title, Align::right);
    for (const TimedRow& row : report.rows) {
        const TimedStatistics& t = row.totals;
        const std::vector<std::string> identity{row.series.strategy, fmt::format("{}", row.series.spp), row.series.gpu};
        const auto add = [&](TextTable& table, std::vector<std::string> cells) {
            cells.insert(cells.begin(), identity.begin(), identity.end());
            table.row(cells);
        };
        add(times, {fmt::format("{}", t.cycles), decimals(1e3 * t.seconds, 3), with_interval(row.cycles_per_ray, 2),
                    row.series.strategy == report.baseline ? "1" : with_interval(row.speed_up, 3),
                    percent(t.occupancy()), fmt::format("{} ({} %)", row.bottleneck, percent(row.bottleneck_share))});
        std::vector<std::string> cells;
        for (const LevelAnswers* level : {&t.l1, &t.l2, &t.l3}) {
            if (!three && level == &t.l3) break;
            cells.push_back(percent(hit_rate(*level, true)));
            cells.push_back(percent(hit_rate(*level, false)));
        }
        cells.push_back(fmt::format("{}", t.dram_sectors));
        add(hits, cells);
        cells.clear();
        for (const Named& r : resources) cells.push_back(percent(utilisation(t, t.*r.resource)));
        for (const Named& r : parts) cells.push_back(percent(utilisation(t, t.*r.resource)));
        add(use, cells);
        add(rates, {decimals(l2_gb_s(row), 1), decimals(t.peak_l2_gb_s, 0), decimals(dram_gb_s(row), 1),
                    decimals(t.peak_dram_gb_s, 0), decimals(visit_latency(t), 0)});
    }
    std::string text = times.text() + "\n" + hits.text() + "\n" + use.text() + "\n" + rates.text() + "\n";
    text +=
        "speed-up: cycles of " + (report.baseline.empty() ? std::string("a baseline") : report.baseline) +
        " over those of the row. occupancy: share of the slots for warps that is taken, on\n"
        "average. hit %: of sector requests, one for each load instruction and sector; a request for a sector on its "
        "way\n"
        "counts as a hit, or in the column \"merges miss\" as none. % of a resource: of its time; L1 tags and L1 data "
        "are\nwhat the L1 port does, MSHRs registers for sectors on their way. L2 slices, L2 GB/s: of the level that "
        "all SMs "
        "share.\n"
        "visit latency: cycles from the first load of a visit to its last data.\n";
    for (const std::string& note : report.notes) text += "note: " + note + "\n";
    return text;
}

std::string to_json(const TimedReport& report) {
    nlohmann::ordered_json rows = nlohmann::ordered_json::array();
    for (const TimedRow& row : report.rows) {
        const TimedStatistics& t = row.totals;
        nlohmann::ordered_json out{{"scene", row.series.scene},
                                   {"strategy", row.series.strategy},
                                   {"sequence", row.series.sequence},
                                   {"parameters", row.series.parameters},
                                   {"thread_map", row.series.thread_map},
                                   {"gpu", row.series.gpu},
                                   {"spp", row.series.spp},
                                   {"samples", samples(row.series)},
                                   {"cycles", t.cycles},
                                   {"seconds", json_of(t.seconds)},
                                   {"cycles_per_ray", json_of(std::optional(row.cycles_per_ray))},
                                   {"speed_up", json_of(row.speed_up)},
                                   {"rays", t.rays},
                                   {"warp_accesses", t.warp_accesses},
                                   {"lane_accesses", t.lane_accesses},
                                   {"instructions", t.instructions},
                                   {"loads", t.loads},
                                   {"l1", json_of(t.l1)},
                                   {"l2", json_of(t.l2)}};
        if (t.l3.requests()) out["l3"] = json_of(t.l3);
        out["dram_sectors"] = t.dram_sectors;
        out["bottleneck"] = row.bottleneck;
        out["occupancy"] = json_of(t.occupancy());
        for (const auto& list : {std::span<const Named>(resources), std::span<const Named>(parts)})
            for (const Named& r : list) out["utilisation"][r.name] = json_of(utilisation(t, t.*r.resource));
        out["l2_gb_s"] = json_of(l2_gb_s(row));
        out["l2_peak_gb_s"] = json_of(t.peak_l2_gb_s);
        out["dram_gb_s"] = json_of(dram_gb_s(row));
        out["dram_peak_gb_s"] = json_of(t.peak_dram_gb_s);
        out["visit_latency"] = json_of(visit_latency(t));
        rows.push_back(std::move(out));
    }
    return nlohmann::ordered_json{{"baseline", report.baseline}, {"rows", rows}, {"notes", report.notes}}.dump(2) +
           "\n";
}

std::string to_csv(const TimedReport& report) {
    std::string text =
        "scene,strategy,sequence,thread_map,gpu,spp,cycles,seconds,cycles_per_ray,speed_up,rays,warp_accesses,"
        "lane_accesses,instructions,loads,l1_hits,l1_merges,l1_line_misses,l1_sector_misses,l2_hits,l2_merges,"
        "l2_line_misses,l2_sector_misses,l3_hits,l3_merges,l3_line_misses,l3_sector_misses,dram_sectors,issue,l1_port,"
        "crossbar,l2_slices,dram,l1_tags,l1_data,l1_mshrs,l2_mshrs,occupancy,l2_gb_s,l2_peak_gb_s,dram_gb_s,"
        "dram_peak_gb_s,visit_latency,bottleneck\n";
    for (const TimedRow& row : report.rows) {
        const TimedStatistics& t = row.totals;
        const TimedSeries& s = row.series;
        for (const std::string* name : {&s.scene, &s.strategy, &s.sequence, &s.thread_map, &s.gpu})
            text += csv_field(*name) + ',';
        text += fmt::format("{},{},{},{},{},{},{},{},{},{}", s.spp, t.cycles, t.seconds, row.cycles_per_ray.mean,
                            row.speed_up ? fmt::format("{}", row.speed_up->mean) : "", t.rays, t.warp_accesses,
                            t.lane_accesses, t.instructions, t.loads);
        for (const LevelAnswers* a : {&t.l1, &t.l2, &t.l3})
            text += fmt::format(",{},{},{},{}", a->hits, a->merges, a->line_misses, a->sector_misses);
        text += fmt::format(",{}", t.dram_sectors);
        for (const Named& r : resources) text += fmt::format(",{}", utilisation(t, t.*r.resource));
        for (const Named& r : parts) text += fmt::format(",{}", utilisation(t, t.*r.resource));
        for (const double value :
             {t.occupancy(), l2_gb_s(row), t.peak_l2_gb_s, dram_gb_s(row), t.peak_dram_gb_s, visit_latency(t)})
            text += fmt::format(",{}", value);
        text += fmt::format(",{}\n", row.bottleneck);
    }
    return text;
}

}  // namespace raycache::cachesim
