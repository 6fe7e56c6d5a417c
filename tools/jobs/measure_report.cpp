#include "tools/jobs/measure_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "cachesim/report/csv_line.hpp"
#include "cachesim/report/format.hpp"
#include "cachesim/report/json_parts.hpp"
#include "cachesim/report/table.hpp"

namespace raycache::tools {
namespace {

using cachesim::Estimate, cachesim::ratio_of_totals, cachesim::ratio_to_baseline;

std::vector<double> scaled(std::vector<double> values, double factor) {
    for (double& value : values) value *= factor;
    return values;
}

std::vector<double> ones(std::size_t count) { return std::vector<double>(count, 1.0); }

const MeasuredWalk* baseline_walk_of(const MeasureResult& result, const MeasuredWalk& walk) {
    for (const MeasuredWalk& other : result.walks)
        if (!other.control && other.strategy == result.baseline && other.spp == walk.spp &&
            other.sequence == walk.sequence && other.mode == walk.mode && other.order == walk.order &&
            other.group == walk.group)
            return &other == &walk ? nullptr : &other;
    return nullptr;
}

MeasureRow row_of(const MeasureResult& result, const MeasuredWalk& walk) {
    MeasureRow row{&walk,
                   ratio_of_totals({scaled(walk.rays, 1e-6), walk.seconds}),
                   ratio_of_totals({scaled(walk.seconds, 1e9), walk.rays}),
                   {},
                   {},
                   {}};
    for (const std::vector<double>& counter : walk.counters)
        row.counters.push_back(ratio_of_totals({counter, walk.rays}));
    if (const MeasuredWalk* base = baseline_walk_of(result, walk)) {
        row.speed_up = ratio_to_baseline({base->seconds, base->rays}, {walk.seconds, walk.rays});
        const std::vector<double> each = ones(walk.seconds.size());
        row.speed_up_per_index = ratio_to_baseline({base->seconds, each}, {walk.seconds, each});
    }
    return row;
}

std::string place_of(const MeasuredWalk& walk) {
    return fmt::format("N={}, {}, {} order{}", walk.spp, walk.mode, walk.order,
                       walk.group == "all" ? "" : ", " + walk.group);
}

void add_notes(MeasureReport& report) {
    constexpr std::uint64_t few = 10000;  // one in so many: rounding at edges
    bool one_index = false;
    std::set<std::string> ends_said;
    for (const MeasureRow& row : report.rows) {
        const MeasuredWalk& walk = *row.walk;
        one_index |= walk.rays.size() == 1;
        if (walk.control && row.speed_up && row.speed_up->half_width &&
            std::fabs(row.speed_up->mean - 1) > *row.speed_up->half_width)
            report.warnings.push_back(
                fmt::format("the control ({} with seed {}) of {} differs from 1: {}; what else ran on this machine, or "
                            "chance (1 in 20), is as large as that",
                            walk.strategy, walk.seed, place_of(walk), cachesim::with_interval(row.speed_up, 3)));
        const auto rays = static_cast<std::uint64_t>(std::accumulate(walk.rays.begin(), walk.rays.end(), 0.0));
        if (walk.other_ends * few > rays && walk.order == "warp" && walk.group == "all" &&
            ends_said.insert(row_name(walk) + place_of(walk)).second)
            report.notes.push_back(fmt::format("{}, {}: {} of {} rays end elsewhere than in the tracer's own walk",
                                               row_name(walk), place_of(walk), walk.other_ends, rays));
    }
    report.notes.insert(report.notes.begin(), report.warnings.begin(), report.warnings.end());
    if (one_index) report.notes.emplace_back("one sample index: no confidence interval, and no verdict on the control");
}

/// In the order of a table.
std::string machine_text(const MeasureResult& result) {
    return fmt::format("{} ({} thread{}, frequency governor {}), Embree {} with {}", result.machine.cpu,
                       result.machine.threads, result.machine.threads == 1 ? "" : "s", result.machine.governor,
                       result.embree.version, result.embree.isa);
}

}  // namespace

MeasureReport make_measure_report(MeasureResult result) {
    MeasureReport report{std::move(result), {}, {}, {}};
    for (const MeasuredWalk& walk : report.result.walks) report.rows.push_back(row_of(report.result, walk));
    add_notes(report);
    return report;
}

std::string row_name(const MeasuredWalk& walk) {
    return walk.control ? fmt::format("control (seed {})", walk.seed) : walk.strategy;
}

std::string to_text(const MeasureReport& report, std::size_t width) {
    using Align = cachesim::TextTable::Align;
    const MeasureResult& result = report.result;
    const std::size_t indices = result.walks.empty() ? 0 : result.walks.front().rays.size();
    std::string text = cachesim::paragraph(fmt::format("{}, {} sample ind{}; {}", result.scene, indices,
                                                       indices == 1 ? "ex" : "ices", machine_text(result)));
    cachesim::TextTable table;
    table.column("strategy", Align::left);
    table.subject("N", Align::right);
    table.subject("sequence", Align::left);
    table.subject("rays", Align::left);
    table.column("mode", Align::left);
    table.subject("order", Align::left);
    table.column("Mrays/s", Align::right);
    table.column("ns/ray", Align::right, 2);
    table.column("speed-up", Align::right);
    table.column("per index", Align::right, 1);
    for (const std::string& counter : result.counters) table.column(counter + "/ray", Align::right, 3);
    for (const MeasureRow& row : report.rows) {
        const MeasuredWalk& walk = *row.walk;
        const auto speed_up = [](const std::optional<Estimate>& e) {
            return e ? cachesim::with_interval(e, 3) : std::string("1");
        };
        std::vector<std::string> cells{row_name(walk),
                                       std::to_string(walk.spp),
                                       walk.sequence,
                                       walk.group,
                                       walk.mode,
                                       walk.order,
                                       cachesim::figure(row.mrays_per_second.mean),
                                       cachesim::figure(row.ns_per_ray.mean),
                                       speed_up(row.speed_up),
                                       speed_up(row.speed_up_per_index)};
        for (const Estimate& counter : row.counters) cells.push_back(cachesim::figure(counter.mean));
        table.row(std::move(cells));
    }
    text += '\n' + table.text(width) + '\n';
    text += cachesim::paragraph(fmt::format(
        "Processor time of one thread, median of {} walk{} of each sample index. speed-up: time per ray of {} over "
        "that "
        "of the row; per index: time of the same sample indices. ±: 95 % confidence interval over sample indices.",
        result.repeats, result.repeats == 1 ? "" : "s", result.baseline));
    for (const std::string& note : report.notes) text += cachesim::paragraph("note: " + note, 2);
    return text;
}

std::string to_json(const MeasureReport& report) {
    using cachesim::json_of;
    const MeasureResult& result = report.result;
    Json rows = Json::array();
    for (const MeasureRow& row : report.rows) {
        const MeasuredWalk& walk = *row.walk;
        Json json{{"strategy", walk.strategy},
                  {"sequence", walk.sequence},
                  {"spp", walk.spp},
                  {"parameters", walk.parameters},
                  {"thread_map", walk.thread_map},
                  {"seed", walk.seed},
                  {"control", walk.control},
                  {"mode", walk.mode},
                  {"order", walk.order},
                  {"group", walk.group},
                  {"rays", walk.rays},
                  {"seconds", walk.seconds},
                  {"mrays_per_second", json_of(row.mrays_per_second)},
                  {"ns_per_ray", json_of(row.ns_per_ray)},
                  {"speed_up", json_of(row.speed_up)},
                  {"speed_up_per_index", json_of(row.speed_up_per_index)},
                  {"other_ends", walk.other_ends}};
        for (std::size_t c = 0; c < result.counters.size(); ++c)
            json[result.counters[c] + "_per_ray"] = json_of(row.counters[c]);
        rows.push_back(std::move(json));
    }
    return cachesim::dump({{"scene", result.scene},
                           {"machine",
                            {{"cpu", result.machine.cpu},
                             {"threads", result.machine.threads},
                             {"governor", result.machine.governor},
                             {"embree", result.embree.version},
                             {"isa", result.embree.isa},
                             {"packet_widths", result.embree.widths},
                             {"counters", result.counters}}},
                           {"baseline", result.baseline},
                           {"repeats", result.repeats},
                           {"rows", std::move(rows)},
                           {"notes", report.notes}});
}

std::string to_csv(const MeasureReport& report) {
    const MeasureResult& result = report.result;
    cachesim::CsvLine titles;
    for (const char* title : {"scene",
                              "strategy",
                              "sequence",
                              "spp",
                              "parameters",
                              "thread_map",
                              "seed",
                              "control",
                              "mode",
                              "order",
                              "group",
                              "rays",
                              "seconds",
                              "mrays_per_second",
                              "mrays_per_second_ci95",
                              "ns_per_ray",
                              "ns_per_ray_ci95",
                              "speed_up",
                              "speed_up_ci95",
                              "speed_up_per_index",
                              "speed_up_per_index_ci95",
                              "other_ends"})
        titles.text(title);
    for (const std::string& counter : result.counters) {
        titles.text(counter + "_per_ray");
        titles.text(counter + "_per_ray_ci95");
    }
    std::string text = titles.end();
    const auto sum = [](const std::vector<double>& values) {
        return std::accumulate(values.begin(), values.end(), 0.0);
    };
    for (const MeasureRow& row : report.rows) {
        const MeasuredWalk& walk = *row.walk;
        cachesim::CsvLine line;
        for (const auto* name : {&result.scene, &walk.strategy, &walk.sequence}) line.text(*name);
        line.number(walk.spp);
        for (const auto* name : {&walk.parameters, &walk.thread_map}) line.text(*name);
        line.number(walk.seed);
        line.text(walk.control ? "true" : "false");
        for (const auto* name : {&walk.mode, &walk.order, &walk.group}) line.text(*name);
        line.number(sum(walk.rays));
        line.number(sum(walk.seconds));
        line.estimate(row.mrays_per_second);
        line.estimate(row.ns_per_ray);
        line.estimate(row.speed_up);
        line.estimate(row.speed_up_per_index);
        line.number(walk.other_ends);
        for (const Estimate& counter : row.counters) line.estimate(counter);
        text += line.end();
    }
    return text;
}

}  // namespace raycache::tools
