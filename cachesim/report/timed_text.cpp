// A timed report as tables for a terminal.
#include <fmt/format.h>

#include <cstddef>
#include <span>
#include <string_view>
#include <type_traits>

#include "cachesim/report/cold_launches.hpp"
#include "cachesim/report/format.hpp"
#include "cachesim/report/table.hpp"
#include "cachesim/report/timed_report.hpp"
#include "cachesim/report/verdict.hpp"
#include "cachesim/report/window_notes.hpp"

namespace raycache::cachesim {

namespace {

using Align = TextTable::Align;

std::string share_text(double share) { return decimals(100 * share, 1); }

/// "DRAM (81.2 %)", "latency; busiest: L1 port (31.0 %)".
std::string bottleneck(const TimedRow& row) {
    if (!row.has_time()) return "-";
    return fmt::format("{}{} ({} %)", row.waits_most() ? "latency; busiest: " : "", row.busiest,
                       share_text(row.busiest_share));
}

/// Tables whose first columns say which row of the report theirs is.
class Tables {
public:
    explicit Tables(const TimedReport& report) : report_(report) {
        // Settings of one strategy that tell rows apart, such as K.
        for (const TimedRow& row : report.rows)
            for (const TimedRow& other : report.rows)
                with_parameters_ |=
                    row.strategy == other.strategy && row.spp == other.spp && row.parameters != other.parameters;
    }

    TextTable make() const {
        TextTable table;
        table.subject("strategy", Align::left);
        if (with_parameters_) table.subject("parameters", Align::left);
        table.subject("N", Align::right);
        table.subject("GPU", Align::left);
        return table;
    }
    void add(TextTable& table, const TimedRow& row, const std::vector<std::string>& cells) const {
        std::vector<std::string> all{row.strategy};
        if (with_parameters_) all.push_back(row.parameters.empty() ? "-" : row.parameters);
        all.push_back(fmt::format("{}", row.spp));
        all.push_back(row.gpu);
        all.insert(all.end(), cells.begin(), cells.end());
        table.row(std::move(all));
    }
    std::string cell(const TimedRow& row, std::size_t i) const {
        const TimedFigure& figure = timed_figures[i];
        if (figure.in_time && !row.has_time()) return "-";
        if (figure.of == Of::total) return fmt::format("{}", figure.total(row.totals, row.caches));
        return figure.is_compared() ? against_base(row, row.figures[i]) : figure_cell(figure, row.figures[i]);
    }
    /// Of a row that has a time, in a column that all have: of the others something else says why there is none.
    bool shows_undefined() const {
        const auto shows = [&](const TimedRow& row, std::size_t i) {
            const TimedFigure& figure = timed_figures[i];
            const bool has = figure.column && figure.presence == Presence::always &&
                             !(figure.is_compared() && report_.baseline.empty());
            return has && cell(row, i) == undefined;
        };
        for (const TimedRow& row : report_.rows)
            for (std::size_t i = 0; row.has_time() && i < timed_figures.size(); ++i)
                if (shows(row, i)) return true;
        return false;
    }
    std::string against_base(const TimedRow& row, const std::optional<Estimate>& ratio) const {
        return report_.baseline.is(row) ? "1" : with_interval(ratio, 3);
    }

private:
    const TimedReport& report_;
    bool with_parameters_ = false;
};

/// One of the tables of timed_figures. `words`: what stands in a last column of words, if any.
template <class Words = std::nullptr_t>
std::string figures_table(const TimedReport& report, const Tables& tables, std::size_t width, Table which,
                          const char* title_of_words = nullptr, Words words = nullptr) {
    std::vector<std::size_t> columns;
    for (std::size_t i = 0; i < timed_figures.size(); ++i) {
        const TimedFigure& figure = timed_figures[i];
        if (figure.column && figure.table == which && report.shows(figure.presence)) columns.push_back(i);
    }
    TextTable table = tables.make();
    for (const std::size_t i : columns) table.column(timed_figures[i].column, Align::right, timed_figures[i].rank);
    if (title_of_words) table.column(title_of_words, Align::left);
    for (const TimedRow& row : report.rows) {
        std::vector<std::string> cells;
        for (const std::size_t i : columns) cells.push_back(tables.cell(row, i));
        if constexpr (!std::is_null_pointer_v<Words>) cells.push_back(words(row));
        tables.add(table, row, cells);
    }
    return table.text(width);
}

/// Bytes per ray of the functional replays, and their ratios.
std::string traffic_table(const TimedReport& report, const Tables& tables, std::size_t width) {
    if (report.traffic.rows.empty()) return {};
    TextTable table = tables.make();
    const bool ratios = !report.baseline.empty();
    const std::span<const BytesFigures> all = bytes_figures(report.traffic.has_l3() ? 3 : 2);
    for (std::size_t level = 0; level < all.size(); ++level) {
        // Where there is no room for all, the bytes between L2 and L3 go first, then all but the ratios.
        const bool middle = level > 0 && level + 1 < all.size();
        const char* const title = traffic_figures[all[level].mean.index].column;
        table.column(title, Align::right, ratios ? (middle ? 2 : 1) : 0);
        if (ratios) table.column(std::string(title, std::string_view(title).find(' ')) + " ratio", Align::right);
    }
    for (std::size_t i = 0; i < report.rows.size(); ++i) {
        const Row& row = report.traffic.rows[i];
        std::vector<std::string> cells;
        for (const BytesFigures& bytes : all) {
            cells.push_back(figure_cell(traffic_figures[bytes.mean.index], row[bytes.mean]));
            // A GPU without that level has no bytes of it, and no ratio.
            const bool counted = cells.back() != undefined;
            if (ratios) cells.push_back(counted ? tables.against_base(report.rows[i], row[bytes.ratio]) : undefined);
        }
        tables.add(table, report.rows[i], cells);
    }
    return '\n' + table.text(width);
}

std::string legend(const TimedReport& report) {
    const bool windows = !report.rows.empty() && report.rows.front().windows;
    return paragraph(
        "speed-up: cycles of " + (report.baseline.empty() ? std::string("a baseline") : report.baseline.name()) +
        " over those of the row. occupancy: share of the slots for warps that is taken, on average. L1 %: hits of "
        "load requests, as Nsight Compute counts (l1tex__t_sector_hit_rate), requests for a sector on its way "
        "included; merged %: the share of all requests that are such. L2 %: the same of what L1 asks. B/ray and "
        "their ratios: counted by the functional replay, without time, of " +
        (windows ? "windows with warm caches" : "launches that begin with cold caches") +
        ". % of "
        "a resource: of its time; L1 tags and L1 data are what the L1 port does, MSHRs registers for sectors on "
        "their way. L2 slices, L2 GB/s: of the level that all SMs share. visit latency: cycles from the first load "
        "of a visit to its last data. ±: half width of the 95 % confidence interval over " +
        units_name(windows) + ".");
}

}  // namespace

std::string to_text(const TimedReport& report, std::size_t width) {
    const Tables tables(report);
    std::string text;
    text += figures_table(report, tables, width, Table::main, "bottleneck", bottleneck) +
            traffic_table(report, tables, width) + '\n';
    for (const Table which : {Table::hits, Table::use, Table::rates})
        text += figures_table(report, tables, width, which) + '\n';
    text += paragraph(traversal_note(report) + '.') + legend(report);
    if (!report.traffic.rows.empty()) text += factor_table(report.traffic, width);
    text += cold_tables(report, width);
    if (report.fidelity) text += to_text(*report.fidelity, width);
    if (tables.shows_undefined()) text += undefined_legend;
    std::string verdicts;
    for (std::size_t i = 0; i < report.rows.size(); ++i)
        if (const auto found = verdict_of(report, i); found && !report.traffic.rows.empty())
            verdicts +=
                paragraph(fmt::format("{}: {}.", row_label(report.traffic, report.traffic.rows[i]), found->text), 2);
    if (!verdicts.empty()) text += '\n' + verdicts;
    if (!report.notes.empty()) text += '\n';
    for (const std::string& note : report.notes) text += paragraph("note: " + note, 2);
    return text;
}

}  // namespace raycache::cachesim
