#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

#include "cachesim/report/explanation.hpp"
#include "cachesim/report/report.hpp"
#include "cachesim/report/table.hpp"
#include "traces/printable.hpp"

namespace raycache::cachesim {

namespace {

using Align = TextTable::Align;

/// A column that says which row this is, or a figure of it.
struct Column {
    std::string title;
    Align align;
    std::function<std::string(const Row&)> cell;
};

std::string decimals(double value, int digits) {
    return std::isfinite(value) ? fmt::format("{:.{}f}", value, digits) : "-";
}

/// About four digits, and the half width to the same place.
std::string with_interval(const std::optional<Estimate>& estimate) {
    if (!estimate || !std::isfinite(estimate->mean)) return "-";
    const double size = std::fabs(estimate->mean);
    const int digits = size >= 1000 ? 0 : size >= 100 ? 1 : size >= 10 ? 2 : 3;
    if (!estimate->half_width) return decimals(estimate->mean, digits);
    return fmt::format("{} ±{}", decimals(estimate->mean, digits), decimals(*estimate->half_width, digits));
}

/// 1234567 -> "1 234 567".
std::string grouped(std::uint64_t value) {
    std::string digits = fmt::format("{}", value);
    for (std::size_t at = digits.size(); at > 3;) digits.insert(at -= 3, 1, ' ');
    return digits;
}

std::string percent(const Estimate& rate) { return decimals(100 * rate.mean, 1); }

/// Scene, sequence, thread map and parameters only where they tell rows apart.
std::vector<Column> identity_columns(const Report& report) {
    std::set<std::string> scenes, sequences, thread_maps;
    std::set<std::pair<std::string, std::string>> parameters;
    std::set<std::string> strategies;
    for (const Row& row : report.rows) {
        scenes.insert(row.scene);
        sequences.insert(row.sequence);
        thread_maps.insert(row.thread_map);
        strategies.insert(row.strategy);
        parameters.insert({row.strategy, row.parameters});
    }
    std::vector<Column> columns;
    if (scenes.size() > 1) columns.push_back({"scene", Align::left, &Row::scene});
    columns.push_back({"strategy", Align::left, &Row::strategy});
    if (parameters.size() > strategies.size()) columns.push_back({"parameters", Align::left, &Row::parameters});
    if (sequences.size() > 1) columns.push_back({"sequence", Align::left, &Row::sequence});
    if (thread_maps.size() > 1) columns.push_back({"threads", Align::left, &Row::thread_map});
    columns.push_back({"N", Align::right, [](const Row& r) { return fmt::format("{}", r.spp); }});
    columns.push_back({"GPU", Align::left, &Row::gpu});
    if (report.by != GroupBy::none) columns.push_back({"group", Align::left, &Row::group});
    return columns;
}

std::string table(const std::vector<Column>& columns, const std::vector<const Row*>& rows) {
    TextTable table;
    for (const Column& column : columns) table.column(column.title, column.align);
    for (const Row* row : rows) {
        std::vector<std::string> cells;
        for (const Column& column : columns) cells.push_back(column.cell(*row));
        table.row(std::move(cells));
    }
    return table.text();
}

std::string main_table(const Report& report, std::vector<Column> columns) {
    const auto figure = [&](const char* title, std::function<std::string(const Row&)> cell) {
        columns.push_back({title, Align::right, std::move(cell)});
    };
    figure("rays", [](const Row& r) { return grouped(r.totals.rays); });
    figure("steps/ray", [](const Row& r) { return decimals(r.steps_per_ray.mean, 1); });
    figure("lanes/acc", [](const Row& r) { return decimals(r.active_lanes.mean, 2); });
    figure("sectors/acc", [](const Row& r) { return decimals(r.sectors_per_access.mean, 2); });
    figure("L1 %", [](const Row& r) { return percent(r.l1_hit_rate); });
    figure("L2 %", [](const Row& r) { return percent(r.l2_hit_rate); });
    if (report.has_l3()) figure("L3 %", [](const Row& r) { return r.l3_hit_rate ? percent(*r.l3_hit_rate) : "-"; });
    figure("L2->L1 B/ray", [](const Row& r) { return with_interval(r.l2_bytes_per_ray); });
    if (report.has_l3()) figure("L3->L2 B/ray", [](const Row& r) { return with_interval(r.l3_bytes_per_ray); });
    figure("DRAM B/ray", [](const Row& r) { return with_interval(r.dram_bytes_per_ray); });
    if (report.has_wavefront()) {
        figure("written", [](const Row& r) { return with_interval(r.written_bytes_per_ray); });
        figure("sort", [](const Row& r) { return with_interval(r.sort_bytes_per_ray); });
    }
    if (!report.baseline.empty())
        figure("DRAM ratio", [&](const Row& r) {
            return r.strategy == report.baseline ? "baseline" : with_interval(r.dram_bytes_ratio);
        });
    std::vector<const Row*> rows;
    for (const Row& row : report.rows) rows.push_back(&row);
    return table(columns, rows);
}

std::string factor_table(const Report& report, std::vector<Column> columns) {
    const auto figure = [&](const char* title, double (*value)(const Factors&)) {
        columns.push_back({title, Align::right, [value](const Row& r) { return decimals(value(*r.factors), 3); }});
    };
    figure("work", [](const Factors& f) { return f.work; });
    figure("x SIMT efficiency", [](const Factors& f) { return f.simt_efficiency; });
    figure("x coalescing", [](const Factors& f) { return f.coalescing; });
    figure("x L1 locality", [](const Factors& f) { return f.l1_locality; });
    columns.push_back({"= L2->L1 ratio", Align::right, [](const Row& r) { return with_interval(r.l2_bytes_ratio); }});
    figure("x L2 locality", [](const Factors& f) { return f.l2_locality; });
    if (report.has_l3())
        columns.push_back({"x L3 locality", Align::right,
                           [](const Row& r) { return r.levels == 3 ? decimals(r.factors->l3_locality, 3) : "-"; }});
    columns.push_back({"= DRAM ratio", Align::right, [](const Row& r) { return with_interval(r.dram_bytes_ratio); }});
    std::vector<const Row*> rows;
    for (const Row& row : report.rows)
        if (row.factors) rows.push_back(&row);
    if (rows.empty()) return {};
    return fmt::format("\nWhere the ratios to {} come from; below 1 is better\n\n", report.baseline) +
           table(columns, rows) +
           fmt::format(
               "\nwork: steps/ray; SIMT efficiency: warp accesses/step; coalescing: sectors/warp access; {} locality: "
               "miss "
               "rates; each over the baseline's.\n",
               report.has_l3() ? "L1, L2, L3" : "L1, L2");
}

}  // namespace

std::string to_text(const Report& report) {
    const std::vector<Column> columns = identity_columns(report);
    std::string text = main_table(report, columns);
    text += fmt::format(
        "\nrays: all sample indices together; step: one lane's visit to a node or triangle; acc: warp access; "
        "{}: sectors found;\nB/ray: bytes read; ±: 95 % confidence over sample indices",
        report.has_l3() ? "L1 %, L2 %, L3 %" : "L1 %, L2 %");
    text +=
        report.baseline.empty() ? ".\n" : fmt::format("; DRAM ratio: DRAM B/ray over that of {}.\n", report.baseline);
    if (report.has_wavefront())
        text +=
            "Wavefronts: DRAM B/ray includes what kernels write to it and what sorting rays reads and writes; both are "
            "given apart.\n";
    text += factor_table(report, columns);
    if (const std::string why = factor_sentences(report); !why.empty()) text += '\n' + why;
    if (!report.notes.empty()) text += '\n';
    for (const std::string& note : report.notes) text += "note: " + printable_line(note) + '\n';
    return text;
}

}  // namespace raycache::cachesim
