#include "cachesim/report/timed_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
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
constexpr Named resources[] = {{"issue", &TimedStatistics::issue},
                               {"L1 port", &TimedStatistics::l1_port},
                               {"crossbar", &TimedStatistics::crossbar},
                               {"L2 slices", &TimedStatistics::l2_slices},
                               {"DRAM", &TimedStatistics::dram}};

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

double gigabytes_per_second(const TimedStatistics& t, std::uint64_t sectors, std::uint32_t sector_bytes) {
    return ratio(static_cast<double>(sectors) * sector_bytes / 1e9, t.seconds);
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
        if (row.bottleneck_share < 0.5) row.bottleneck = "latency";
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
    TextTable times, use;
    for (TextTable* table : {&times, &use}) {
        table->column("strategy", Align::left);
        table->column("N", Align::right);
        table->column("GPU", Align::left);
    }
    for (const char* title :
         {"cycles", "ms", "cycles/ray", "speed-up", "L1 hit %", "(merges miss)", "L2 hit %", "DRAM sectors"})
        times.column(title, Align::right);
    times.column("bottleneck", Align::left);
    for (const char* title :
         {"issue %", "L1 port %", "crossbar %", "L2 slices %", "DRAM %", "L2 GB/s", "DRAM GB/s", "visit latency"})
        use.column(title, Align::right);
    for (const TimedRow& row : report.rows) {
        const TimedStatistics& t = row.totals;
        const std::vector<std::string> identity{row.series.strategy, fmt::format("{}", row.series.spp), row.series.gpu};
        std::vector<std::string> cells = identity;
        cells.insert(cells.end(),
                     {fmt::format("{}", t.cycles), decimals(1e3 * t.seconds, 3), with_interval(row.cycles_per_ray, 2),
                      row.series.strategy == report.baseline ? "1" : with_interval(row.speed_up, 3),
                      percent(hit_rate(t.l1, true)), percent(hit_rate(t.l1, false)), percent(hit_rate(t.l2, true)),
                      fmt::format("{}", t.dram_sectors),
                      fmt::format("{} ({} %)", row.bottleneck, percent(row.bottleneck_share))});
        times.row(cells);
        cells = identity;
        for (const Named& r : resources) cells.push_back(percent(utilisation(t, t.*r.resource)));
        cells.push_back(decimals(gigabytes_per_second(t, t.l2.requests(), row.series.sector_bytes), 1));
        cells.push_back(decimals(gigabytes_per_second(t, t.dram_sectors, row.series.sector_bytes), 1));
        cells.push_back(decimals(ratio(static_cast<double>(t.visit_cycles), static_cast<double>(t.warp_accesses)), 0));
        use.row(cells);
    }
    std::string text = times.text() + "\n" + use.text() + "\n";
    text +=
        "L1 and L2 hit %: of sector requests, one for each load instruction and sector; a request for a sector on its\n"
        "way counts as a hit, or in the column \"merges miss\" as none. visit latency: cycles from the first load of "
        "a\n"
        "visit to its last data. speed-up: cycles of " +
        (report.baseline.empty() ? std::string("a baseline") : report.baseline) + " over those of the row.\n";
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
                                   {"l2", json_of(t.l2)},
                                   {"dram_sectors", t.dram_sectors},
                                   {"bottleneck", row.bottleneck}};
        for (const Named& r : resources) out["utilisation"][r.name] = json_of(utilisation(t, t.*r.resource));
        out["visit_latency"] =
            json_of(ratio(static_cast<double>(t.visit_cycles), static_cast<double>(t.warp_accesses)));
        rows.push_back(std::move(out));
    }
    return nlohmann::ordered_json{{"baseline", report.baseline}, {"rows", rows}, {"notes", report.notes}}.dump(2) +
           "\n";
}

std::string to_csv(const TimedReport& report) {
    std::string text =
        "scene,strategy,sequence,thread_map,gpu,spp,cycles,seconds,cycles_per_ray,speed_up,rays,warp_accesses,"
        "lane_accesses,instructions,loads,l1_hits,l1_merges,l1_line_misses,l1_sector_misses,l2_hits,l2_merges,"
        "l2_line_misses,l2_sector_misses,dram_sectors,issue,l1_port,crossbar,l2_slices,dram,bottleneck\n";
    for (const TimedRow& row : report.rows) {
        const TimedStatistics& t = row.totals;
        const TimedSeries& s = row.series;
        for (const std::string* name : {&s.scene, &s.strategy, &s.sequence, &s.thread_map, &s.gpu})
            text += csv_field(*name) + ',';
        text += fmt::format("{},{},{},{},{},{},{},{},{},{}", s.spp, t.cycles, t.seconds, row.cycles_per_ray.mean,
                            row.speed_up ? fmt::format("{}", row.speed_up->mean) : "", t.rays, t.warp_accesses,
                            t.lane_accesses, t.instructions, t.loads);
        for (const LevelAnswers* a : {&t.l1, &t.l2})
            text += fmt::format(",{},{},{},{}", a->hits, a->merges, a->line_misses, a->sector_misses);
        text += fmt::format(",{}", t.dram_sectors);
        for (const Named& r : resources) text += fmt::format(",{}", utilisation(t, t.*r.resource));
        text += fmt::format(",{}\n", row.bottleneck);
    }
    return text;
}

}  // namespace raycache::cachesim
