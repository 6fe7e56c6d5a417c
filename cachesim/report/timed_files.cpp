// A timed report as JSON and as CSV.
#include <fmt/format.h>

#include <cmath>
#include <span>

#include "cachesim/report/csv_field.hpp"
#include "cachesim/report/json_key.hpp"
#include "cachesim/report/json_parts.hpp"
#include "cachesim/report/timed_figures.hpp"

namespace raycache::cachesim {

using namespace figures;

namespace {

Json answers_of(const LevelAnswers& a) {
    return {{"requests", a.requests()},
            {"hits", a.hits},
            {"merges", a.merges},
            {"line_misses", a.line_misses},
            {"sector_misses", a.sector_misses},
            {"hit_rate", json_of(hit_rate(a, true))},
            {"hit_rate_merges_miss", json_of(hit_rate(a, false))}};
}

Json text_in_time(const TimedRow& row, const std::string& text) { return row.has_time() ? Json(text) : Json(nullptr); }

/// Empty where there is no value.
std::string field(double value) { return std::isfinite(value) ? fmt::format("{}", value) : ""; }

/// "mean,half width", each empty where it does not exist.
std::string fields(const std::optional<Estimate>& e) {
    return (e ? field(e->mean) : "") + ',' + (e && e->half_width ? field(*e->half_width) : "");
}

}  // namespace

std::string to_json(const TimedReport& report) {
    Json rows = Json::array();
    for (std::size_t i = 0; i < report.rows.size(); ++i) {
        const TimedRow& row = report.rows[i];
        const TimedStatistics& t = row.totals;
        Json out{{"scene", row.series.scene},
                 {"strategy", row.series.strategy},
                 {"sequence", row.series.sequence},
                 {"parameters", row.series.parameters},
                 {"thread_map", row.series.thread_map},
                 {"gpu", row.series.gpu},
                 {"spp", row.series.spp},
                 {"samples", samples(row.series)},
                 {"cycles", row.has_time() ? Json(t.cycles) : Json(nullptr)},
                 {"seconds", json_of(in_time(row, t.seconds))},
                 {"cycles_per_ray", row.has_time() ? json_of(row.cycles_per_ray) : Json(nullptr)},
                 {"speed_up", json_of(row.speed_up)},
                 {"rays", t.rays},
                 {"warp_accesses", t.warp_accesses},
                 {"lane_accesses", t.lane_accesses},
                 {"instructions", t.instructions},
                 {"loads", t.loads},
                 {"l1", answers_of(t.l1)},
                 {"l2", answers_of(t.l2)}};
        if (t.l3.requests()) out["l3"] = answers_of(t.l3);
        out["dram_sectors"] = t.dram_sectors;
        out["bottleneck"] = text_in_time(row, row.waits_most() ? "latency" : row.busiest);
        out["busiest"] = text_in_time(row, row.busiest);
        out["occupancy"] = json_of(occupancy(row));
        for (const auto& list : {std::span<const Named>(resources), std::span<const Named>(parts)})
            for (const Named& r : list) out["utilisation"][snake_case(r.name)] = json_of(utilisation(row, r));
        out["l2_gb_s"] = json_of(l2_gb_s(row));
        out["l2_peak_gb_s"] = json_of(t.peak_l2_gb_s);
        out["dram_gb_s"] = json_of(dram_gb_s(row));
        out["dram_peak_gb_s"] = json_of(t.peak_dram_gb_s);
        out["visit_latency"] = json_of(visit_latency(row));
        if (!report.traffic.rows.empty()) out["traffic"] = traffic_json(report.traffic, i);
        const auto found = verdict_of(report, i);
        out["verdict"] = found ? json_of(*found) : Json(nullptr);
        rows.push_back(std::move(out));
    }
    return dump({{"baseline", report.baseline}, {"rows", rows}, {"notes", report.notes}});
}

std::string to_csv(const TimedReport& report) {
    std::string text =
        "scene,strategy,sequence,thread_map,gpu,spp,cycles,seconds,cycles_per_ray,cycles_per_ray_ci95,speed_up,speed_"
        "up_ci95,rays,warp_accesses,"
        "lane_accesses,instructions,loads,l1_hits,l1_merges,l1_line_misses,l1_sector_misses,l2_hits,l2_merges,"
        "l2_line_misses,l2_sector_misses,l3_hits,l3_merges,l3_line_misses,l3_sector_misses,dram_sectors,issue,l1_port,"
        "crossbar,l2_slices,dram,l1_tags,l1_data,l1_mshrs,l2_mshrs,occupancy,l2_gb_s,l2_peak_gb_s,dram_gb_s,"
        "dram_peak_gb_s,visit_latency,bottleneck,busiest,l1_hit_rate,l2_hit_rate,l2_bytes_per_ray,"
        "l2_bytes_per_ray_ci95,dram_bytes_per_ray,dram_bytes_per_ray_ci95,dram_compulsory_share,l2_bytes_ratio,"
        "l2_bytes_ratio_ci95,dram_bytes_ratio,dram_bytes_ratio_ci95,verdict_level,verdict\n";
    for (std::size_t i = 0; i < report.rows.size(); ++i) {
        const TimedRow& row = report.rows[i];
        const TimedStatistics& t = row.totals;
        const TimedSeries& s = row.series;
        for (const std::string* name : {&s.scene, &s.strategy, &s.sequence, &s.thread_map, &s.gpu})
            text += csv_field(*name) + ',';
        text += fmt::format("{},{},{},{},{},{},{},{},{},{}", s.spp, row.has_time() ? fmt::format("{}", t.cycles) : "",
                            field(in_time(row, t.seconds)),
                            fields(row.has_time() ? std::optional(row.cycles_per_ray) : std::nullopt),
                            fields(row.speed_up), t.rays, t.warp_accesses, t.lane_accesses, t.instructions, t.loads);
        for (const LevelAnswers* a : {&t.l1, &t.l2, &t.l3})
            text += fmt::format(",{},{},{},{}", a->hits, a->merges, a->line_misses, a->sector_misses);
        text += fmt::format(",{}", t.dram_sectors);
        for (const Named& r : resources) text += ',' + field(utilisation(row, r));
        for (const Named& r : parts) text += ',' + field(utilisation(row, r));
        for (const double value :
             {occupancy(row), l2_gb_s(row), t.peak_l2_gb_s, dram_gb_s(row), t.peak_dram_gb_s, visit_latency(row)})
            text += ',' + field(value);
        text += row.has_time() ? fmt::format(",{},{}", row.waits_most() ? "latency" : row.busiest, row.busiest) : ",,";
        const Row traffic = report.traffic.rows.empty() ? Row{} : report.traffic.rows[i];
        const bool has = !report.traffic.rows.empty();
        const auto add = [&](const std::optional<Estimate>& e) { text += ',' + fields(has ? e : std::nullopt); };
        text += ',' + field(hit_rate(t.l1, true)) + ',' + field(hit_rate(t.l2, true));
        add(traffic.l2_bytes_per_ray);
        add(traffic.dram_bytes_per_ray);
        text += ',' + (has ? field(traffic.dram_compulsory_share.mean) : "");
        add(traffic.l2_bytes_ratio);
        add(traffic.dram_bytes_ratio);
        const Verdict found = verdict_of(report, i).value_or(Verdict{});
        text += ',' + found.level.value_or("") + ',' + csv_field(found.text) + '\n';
    }
    return text;
}

}  // namespace raycache::cachesim
