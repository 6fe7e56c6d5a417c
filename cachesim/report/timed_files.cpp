// A timed report as JSON and as CSV.
#include <cmath>
#include <initializer_list>

#include "cachesim/report/cold_launches.hpp"
#include "cachesim/report/csv_line.hpp"
#include "cachesim/report/json_parts.hpp"
#include "cachesim/report/timed_report.hpp"

namespace raycache::cachesim {

namespace {

Json text_in_time(const TimedRow& row, const std::string& text) { return row.has_time() ? Json(text) : Json(nullptr); }

/// What a figure says of a row.
Json figure_of(const TimedRow& row, std::size_t i) {
    const TimedFigure& figure = timed_figures[i];
    if (figure.of == Of::total && (row.has_time() || !figure.in_time)) return figure.total(row.totals, row.caches);
    if (figure.has_interval() || !row.figures[i]) return json_of(row.figures[i]);
    return json_of(row.figures[i]->mean);
}

Json row_json(const TimedReport& report, std::size_t n) {
    const TimedRow& row = report.rows[n];
    Json out = names_of(row);
    out.update({{"spp", row.spp}, {"samples", row.samples()}, {"traversal", row.traversal}});
    for (std::size_t i = 0; i < timed_figures.size(); ++i) {
        const TimedFigure& figure = timed_figures[i];
        if (!figure.in_json() || (figure.presence == Presence::three_levels && !row.totals.levels[2].requests()) ||
            (figure.presence == Presence::rt_unit && !row.by_rt_unit()))
            continue;
        (figure.object ? out[figure.object] : out)[figure.name] = figure_of(row, i);
        if (i != TimedKey("dram_sectors").index) continue;
        out["bottleneck"] = text_in_time(row, row.waits_most() ? "latency" : row.busiest);
        out["busiest"] = text_in_time(row, row.busiest);
    }
    if (!report.traffic.rows.empty()) out["traffic"] = traffic_json(report.traffic, n);
    if (!report.cold.empty()) out["cold_launches"] = cold_json(report.cold[n]);
    const auto found = verdict_of(report, n);
    out["verdict"] = found ? json_of(*found) : Json(nullptr);
    return out;
}

/// The fields of timed_figures, part by part: counts and utilisation; what follows from them; hit rates.
template <class Use>
void for_each_field(unsigned part, const Use& use) {
    for (std::size_t i = 0; i < timed_figures.size(); ++i)
        if (timed_figures[i].in_csv() && timed_figures[i].part == part) use(timed_figures[i], i);
}

/// Of the functional replay. Without an interval: the share of compulsory misses.
constexpr TrafficKey of_traffic[] = {"l2_bytes_per_ray", "dram_bytes_per_ray", "dram_compulsory_share",
                                     "l2_bytes_ratio", "dram_bytes_ratio"};
constexpr bool has_interval(TrafficKey key) { return key.index != TrafficKey("dram_compulsory_share").index; }

std::size_t cold_levels(const TimedReport& report) { return report.traffic.has_l3() ? 3 : 2; }

std::string titles(const TimedReport& report) {
    CsvLine line;
    const auto add = [&](std::initializer_list<const char*> titles) {
        for (const char* title : titles) line.text(title);
    };
    add({"scene", "strategy", "sequence", "thread_map", "gpu", "spp"});
    for (unsigned part = 0; part < 3; ++part) {
        for_each_field(part, [&](const TimedFigure& figure, std::size_t) { add_title(line, figure); });
        if (part == 1) add({"bottleneck", "busiest"});
    }
    for (const TrafficKey key : of_traffic)
        has_interval(key) ? add_title(line, traffic_figures[key.index]) : line.text(traffic_figures[key.index].key);
    add({"verdict_level", "verdict", "traversal"});
    if (!report.cold.empty()) add_cold_titles(line, cold_levels(report), true);
    return line.end();
}

std::string fields(const TimedReport& report, std::size_t n) {
    const TimedRow& row = report.rows[n];
    CsvLine line;
    for (const std::string* name : {&row.scene, &row.strategy, &row.sequence, &row.thread_map, &row.gpu})
        line.text(*name);
    line.number(row.spp);
    for (unsigned part = 0; part < 3; ++part) {
        for_each_field(part, [&](const TimedFigure& figure, std::size_t i) {
            if (figure.of == Of::total && (row.has_time() || !figure.in_time))
                line.number(figure.total(row.totals, row.caches));
            else
                add_figure(line, figure, row.figures[i]);
        });
        if (part != 1) continue;
        line.text(!row.has_time() ? "" : row.waits_most() ? "latency" : row.busiest);
        line.text(row.has_time() ? row.busiest : "");
    }
    for (const TrafficKey key : of_traffic) {
        const auto value = report.traffic.rows.empty() ? std::nullopt : report.traffic.rows[n][key];
        has_interval(key) ? line.estimate(value) : line.number(value ? value->mean : std::nan(""));
    }
    const Verdict found = verdict_of(report, n).value_or(Verdict{});
    line.text(found.level.value_or(""));
    line.text(found.text);
    line.text(row.traversal);
    if (!report.cold.empty()) add_cold_fields(line, report.cold[n], cold_levels(report), true);
    return line.end();
}

}  // namespace

std::string to_json(const TimedReport& report) {
    Json rows = Json::array();
    for (std::size_t i = 0; i < report.rows.size(); ++i) rows.push_back(row_json(report, i));
    Json figures = report.traffic.rows.empty() ? Json::array() : figures_json(report.traffic, "traffic");
    for (const TimedFigure& figure : timed_figures)
        if (figure.in_json() && report.shows(figure.presence)) figures.push_back(figure_json(figure, nullptr));
    Json json{{"baseline", report.baseline.strategy},
              {"baseline_gpu", report.baseline.gpu.empty() ? Json(nullptr) : Json(report.baseline.gpu)}};
    if (report.fidelity) json["fidelity"] = to_json_value(*report.fidelity);
    json.update({{"rows", rows}, {"notes", report.notes}, {"figures", figures}});
    return dump(json);
}

std::string to_csv(const TimedReport& report) {
    std::string csv = titles(report);
    for (std::size_t i = 0; i < report.rows.size(); ++i) csv += fields(report, i);
    return csv;
}

}  // namespace raycache::cachesim
