#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

#include "cachesim/analysis/factor_terms.hpp"
#include "cachesim/report/explanation.hpp"
#include "cachesim/report/format.hpp"
#include "cachesim/report/report.hpp"
#include "cachesim/report/table.hpp"

namespace raycache::cachesim {

namespace {

using Align = TextTable::Align;

/// A column that says which row this is, or a figure of it.
struct Column {
    std::string title;
    Align align;
    std::function<std::string(const Row&)> cell;
    unsigned rank = 0;  ///< of TextTable
};

/// 1234567 -> "1 234 567".
std::string grouped(std::uint64_t value) {
    std::string digits = fmt::format("{}", value);
    for (std::size_t at = digits.size(); at > 3;) digits.insert(at -= 3, 1, ' ');
    return digits;
}

std::string percent(const Estimate& rate) { return decimals(100 * rate.mean, 1); }

/// What rows are of. Scene, sequence, thread map and parameters only where they tell rows apart.
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
    if (parameters.size() > strategies.size())
        columns.push_back({"parameters", Align::left,
                           [](const Row& r) { return r.parameters.empty() ? std::string("-") : r.parameters; }});
    if (sequences.size() > 1) columns.push_back({"sequence", Align::left, &Row::sequence});
    if (thread_maps.size() > 1) columns.push_back({"threads", Align::left, &Row::thread_map});
    columns.push_back({"N", Align::right, [](const Row& r) { return fmt::format("{}", r.spp); }});
    columns.push_back({"GPU", Align::left, &Row::gpu});
    if (report.by != GroupBy::none) columns.push_back({"group", Align::left, &Row::group});
    return columns;
}

void add_subjects(TextTable& table, const std::vector<Column>& columns) {
    for (const Column& column : columns) table.subject(column.title, column.align);
}

std::string main_table(const Report& report, std::size_t width) {
    const std::vector<Column> subjects = identity_columns(report);
    std::vector<Column> figures;
    const auto figure = [&](const char* title, unsigned rank, std::function<std::string(const Row&)> cell) {
        figures.push_back({title, Align::right, std::move(cell), rank});
    };
    figure("rays", 7, [](const Row& r) { return grouped(r.totals.rays); });
    figure("steps/ray", 6, [](const Row& r) { return decimals(r.steps_per_ray.mean, 1); });
    figure("lanes/acc", 3, [](const Row& r) { return decimals(r.active_lanes.mean, 2); });
    figure("sectors/acc", 5, [](const Row& r) { return decimals(r.sectors_per_access.mean, 2); });
    figure("L1 %", 1, [](const Row& r) { return percent(r.l1_hit_rate); });
    figure("L2 %", 2, [](const Row& r) { return percent(r.l2_hit_rate); });
    if (report.has_l3()) figure("L3 %", 2, [](const Row& r) { return r.l3_hit_rate ? percent(*r.l3_hit_rate) : "-"; });
    figure("L2->L1 B/ray", 0, [](const Row& r) { return with_interval(r.l2_bytes_per_ray); });
    if (report.has_l3()) figure("L3->L2 B/ray", 0, [](const Row& r) { return with_interval(r.l3_bytes_per_ray); });
    figure("DRAM B/ray", 0, [](const Row& r) { return with_interval(r.dram_bytes_per_ray); });
    if (report.has_wavefront()) {
        figure("written", 4, [](const Row& r) { return with_interval(r.written_bytes_per_ray); });
        figure("sort", 4, [](const Row& r) { return with_interval(r.sort_bytes_per_ray); });
    }
    if (!report.baseline.empty())
        figure("DRAM ratio", 0, [&](const Row& r) {
            return r.strategy == report.baseline ? "baseline" : with_interval(r.dram_bytes_ratio);
        });
    TextTable table;
    add_subjects(table, subjects);
    for (const Column& column : figures) table.column(column.title, column.align, column.rank);
    for (const Row& row : report.rows) {
        std::vector<std::string> cells;
        for (const Column& column : subjects) cells.push_back(column.cell(row));
        for (const Column& column : figures) cells.push_back(column.cell(row));
        table.row(std::move(cells));
    }
    return table.text(width);
}

std::string legend(const Report& report) {
    std::string text = fmt::format(
        "rays: all sample indices together; step: one lane's visit to a node or triangle; acc: warp access; L1 %: hits "
        "of load requests, as Nsight Compute counts (l1tex__t_sector_hit_rate); {}: of sectors asked for; B/ray: bytes "
        "read, by launches that begin with cold caches; ±: half width of the 95 % confidence interval over sample "
        "indices{}.",
        report.has_l3() ? "L2 %, L3 %" : "L2 %",
        report.baseline.empty() ? "" : fmt::format("; DRAM ratio: DRAM B/ray over that of {}", report.baseline));
    if (report.has_wavefront())
        text +=
            " Wavefronts: DRAM B/ray includes what kernels write to it and what sorting rays reads and writes; both "
            "are "
            "given apart.";
    return '\n' + paragraph(text);
}

}  // namespace

/// Factors in the order of the identity with the ratios that they multiply to: a line of means, below it one of
/// half widths.
std::string factor_table(const Report& report, std::size_t width) {
    const std::vector<Column> columns = identity_columns(report);
    struct Cell {
        std::string title;
        std::function<std::optional<Estimate>(const Row&)> value;
    };
    std::vector<Cell> cells;
    const std::size_t levels = report.has_l3() ? 3 : 2;
    constexpr const char* titles[] = {"work", "SIMT", "coal.", "L1 loc.", "L2 loc.", "L3 loc."};
    for (std::size_t i = 0; i < factor_terms(levels).size(); ++i) {
        const FactorTerm& term = factor_terms(levels)[i];
        cells.push_back({titles[i], [&term](const Row& r) {
                             const bool has = term.factor != &Factors::l3_locality || r.levels == 3;
                             return has ? std::optional((*r.factors).*term.factor) : std::nullopt;
                         }});
        if (term.factor == &Factors::l1_locality) cells.push_back({"=L2->L1", &Row::l2_bytes_ratio});
        if (levels == 3 && term.factor == &Factors::l2_locality) cells.push_back({"=L3->L2", &Row::l3_bytes_ratio});
    }
    cells.push_back({"=DRAM", &Row::dram_bytes_ratio});
    TextTable table;
    add_subjects(table, columns);
    for (const Cell& cell : cells) table.column(cell.title, Align::right);
    bool any = false;
    for (const Row& row : report.rows) {
        if (!row.factors) continue;
        any = true;
        std::vector<std::string> means, widths(columns.size());
        for (const Column& column : columns) means.push_back(column.cell(row));
        bool intervals = false;
        for (const Cell& cell : cells) {
            const std::optional<Estimate> value = cell.value(row);
            means.push_back(value ? decimals(value->mean, 3) : "-");
            widths.push_back(value ? half_width_cell(*value, 3) : "");
            intervals |= !widths.back().empty();
        }
        table.row(std::move(means));
        if (intervals) table.row(std::move(widths));
    }
    if (!any) return {};
    return fmt::format("\nWhere the ratios to {} come from; below 1 is better\n\n", report.baseline) +
           table.text(width) + '\n' +
           paragraph(fmt::format("work: steps/ray; SIMT (efficiency): warp accesses/step; coal.(escing): sectors/warp "
                                 "access; L1 loc.(ality): miss rate of visits, {} of sectors asked for; each over the "
                                 "baseline's. Their product is the ratio exactly.",
                                 report.has_l3() ? "L2, L3 loc.: miss rates" : "L2 loc.: miss rate"));
}

std::string to_text(const Report& report, std::size_t width) {
    std::string text = main_table(report, width);
    text += legend(report);
    text += factor_table(report, width);
    if (const std::string why = factor_sentences(report); !why.empty()) text += '\n' + why;
    if (!report.notes.empty()) text += '\n';
    for (const std::string& note : report.notes) text += paragraph("note: " + note, 2);
    return text;
}

}  // namespace raycache::cachesim
