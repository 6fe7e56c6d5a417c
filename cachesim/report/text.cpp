#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <set>
#include <string_view>

#include "cachesim/report/cold_launches.hpp"
#include "cachesim/report/explanation.hpp"
#include "cachesim/report/format.hpp"
#include "cachesim/report/report.hpp"
#include "cachesim/report/table.hpp"
#include "cachesim/report/verdict.hpp"
#include "cachesim/report/window_notes.hpp"

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
    if (scenes.size() > 1) columns.push_back({"scene", Align::left, &Origin::scene});
    columns.push_back({"strategy", Align::left, &Origin::strategy});
    if (parameters.size() > strategies.size())
        columns.push_back({"parameters", Align::left,
                           [](const Row& r) { return r.parameters.empty() ? std::string("-") : r.parameters; }});
    if (sequences.size() > 1) columns.push_back({"sequence", Align::left, &Origin::sequence});
    if (thread_maps.size() > 1) columns.push_back({"threads", Align::left, &Origin::thread_map});
    columns.push_back({"N", Align::right, [](const Row& r) { return fmt::format("{}", r.spp); }});
    columns.push_back({"GPU", Align::left, &Origin::gpu});
    if (report.by != GroupBy::none) columns.push_back({"group", Align::left, &Row::group});
    return columns;
}

void add_subjects(TextTable& table, const std::vector<Column>& columns) {
    for (const Column& column : columns) table.subject(column.title, column.align);
}

/// The figures of the main table.
std::vector<std::size_t> columns_of(const Report& report) {
    std::vector<std::size_t> columns;
    for (std::size_t i = 0; i < std::size(traffic_figures); ++i) {
        const TrafficFigure& figure = traffic_figures[i];
        if (figure.column && !figure.of_factors && report.has(figure.presence) &&
            !(figure.is_compared() && report.baseline.empty()))
            columns.push_back(i);
    }
    return columns;
}

std::string cell(const Report& report, const Row& row, std::size_t i) {
    const TrafficFigure& figure = traffic_figures[i];
    if (figure.of == Of::total) return grouped(figure.total(row.totals, row.caches));
    if (figure.is_compared() && report.baseline.is(row)) return "baseline";
    return figure_cell(figure, row.figures[i]);
}

/// In a column that all rows have: a GPU without an L3 has no figures of it.
bool shows_undefined(const Report& report) {
    const std::vector<std::size_t> columns = columns_of(report);
    return std::any_of(report.rows.begin(), report.rows.end(), [&](const Row& row) {
        return std::any_of(columns.begin(), columns.end(), [&](std::size_t i) {
            return traffic_figures[i].presence == Presence::always && cell(report, row, i) == undefined;
        });
    });
}

std::string main_table(const Report& report, std::size_t width) {
    const std::vector<Column> subjects = identity_columns(report);
    std::vector<Column> figures;
    for (const std::size_t i : columns_of(report))
        figures.push_back({traffic_figures[i].column, Align::right,
                           [&report, i](const Row& row) { return cell(report, row, i); }, traffic_figures[i].rank});
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

/// "L2 %, L3 %: of sectors asked for": what the table says of its columns, each once. `compared`: of ratios.
std::string legend_of(const Report& report, bool compared) {
    struct Entry {
        std::string subjects, words;
    };
    std::vector<Entry> entries;
    for (const std::size_t i : columns_of(report)) {
        const TrafficFigure& figure = traffic_figures[i];
        if (!figure.legend || figure.is_compared() != compared) continue;
        const bool warm = figure.legend == bytes_legend && report.has_windows();
        const std::string words =
            warm ? warm_bytes_legend : fmt::format(fmt::runtime(figure.legend), report.baseline.name());
        if (entries.empty() || entries.back().words != words)
            entries.push_back({figure.subject, words});
        else if (entries.back().subjects != figure.subject)
            entries.back().subjects += std::string(", ") + figure.subject;
    }
    std::string text;
    for (const Entry& e : entries) text += fmt::format("{}{}: {}", text.empty() ? "" : "; ", e.subjects, e.words);
    return text;
}

std::string legend(const Report& report) {
    const std::string ratios = legend_of(report, true);
    std::string text =
        fmt::format("{}; ±: half width of the 95 % confidence interval over {}{}{}.", legend_of(report, false),
                    units_name(report.has_windows()), ratios.empty() ? "" : "; ", ratios);
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
        std::size_t figure;
    };
    std::vector<Cell> cells;
    const std::size_t levels = report.has_l3() ? 3 : 2;
    std::size_t level = 0;
    for (std::size_t i = 0; i < std::size(traffic_figures); ++i) {
        const TrafficFigure& figure = traffic_figures[i];
        if (!figure.column || !figure.of_factors || !report.has(figure.presence)) continue;
        cells.push_back({figure.column, i});
        // Behind the miss rate of a level, what it fetches.
        if (!std::string_view(figure.key).ends_with("locality")) continue;
        const std::string bytes = level + 1 == levels ? "=DRAM" : fmt::format("=L{}->L{}", level + 2, level + 1);
        cells.push_back({bytes, bytes_figures(levels)[level].ratio.index});
        ++level;
    }
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
            const std::optional<Estimate>& value = row.figures[cell.figure];
            means.push_back(value ? decimals(value->mean, 3) : "-");
            widths.push_back(value ? half_width_cell(*value, 3) : "");
            intervals |= !widths.back().empty();
        }
        table.row(std::move(means));
        if (intervals) table.row(std::move(widths));
    }
    if (!any) return {};
    return fmt::format("\nWhere the ratios to {} come from; below 1 is better\n\n", report.baseline.name()) +
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
    text += cold_tables(report, width);
    if (shows_undefined(report)) text += undefined_legend;
    if (const std::string why = factor_sentences(report); !why.empty()) text += '\n' + why;
    if (!report.notes.empty()) text += '\n';
    for (const std::string& note : report.notes) text += paragraph("note: " + note, 2);
    return text;
}

}  // namespace raycache::cachesim
