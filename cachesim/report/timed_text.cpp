// A timed report as tables for a terminal.
#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "cachesim/report/format.hpp"
#include "cachesim/report/table.hpp"
#include "cachesim/report/timed_figures.hpp"
#include "cachesim/report/timed_report.hpp"

namespace raycache::cachesim {

using namespace figures;

namespace {

using Align = TextTable::Align;

std::string percent(double share) { return decimals(100 * share, 1); }

/// "DRAM (81.2 %)", "latency; busiest: L1 port (31.0 %)".
std::string bottleneck(const TimedRow& row) {
    if (!row.has_time()) return "-";
    return fmt::format("{}{} ({} %)", row.waits_most() ? "latency; busiest: " : "", row.busiest,
                       percent(row.busiest_share));
}

/// Tables whose first columns say which row of the report theirs is.
class Tables {
public:
    explicit Tables(const TimedReport& report) : report_(report) {
        // Settings of one strategy that tell rows apart, such as K.
        for (const TimedRow& row : report.rows)
            for (const TimedRow& other : report.rows)
                with_parameters_ |= row.series.strategy == other.series.strategy &&
                                    row.series.spp == other.series.spp &&
                                    row.series.parameters != other.series.parameters;
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
        std::vector<std::string> all{row.series.strategy};
        if (with_parameters_) all.push_back(row.series.parameters.empty() ? "-" : row.series.parameters);
        all.push_back(fmt::format("{}", row.series.spp));
        all.push_back(row.series.gpu);
        all.insert(all.end(), cells.begin(), cells.end());
        table.row(std::move(all));
    }
    std::string against_base(const TimedRow& row, const std::optional<Estimate>& ratio) const {
        return row.series.strategy == report_.baseline ? "1" : with_interval(ratio, 3);
    }

private:
    const TimedReport& report_;
    bool with_parameters_ = false;
};

std::string times_table(const TimedReport& report, const Tables& tables, std::size_t width) {
    TextTable table = tables.make();
    table.column("cycles", Align::right, 3);
    table.column("ms", Align::right, 2);
    table.column("cycles/ray", Align::right, 1);
    for (const char* title : {"speed-up", "occupancy %"}) table.column(title, Align::right);
    table.column("bottleneck", Align::left);
    for (const TimedRow& row : report.rows) {
        const TimedStatistics& t = row.totals;
        const bool time = row.has_time();
        tables.add(table, row,
                   {time ? fmt::format("{}", t.cycles) : "-", decimals(in_time(row, 1e3 * t.seconds), 3),
                    time ? with_interval(row.cycles_per_ray, 2) : "-",
                    time ? tables.against_base(row, row.speed_up) : "-", percent(occupancy(row)), bottleneck(row)});
    }
    return table.text(width);
}

/// Bytes per ray of the functional replays, and their ratios.
std::string traffic_table(const TimedReport& report, const Tables& tables, std::size_t width) {
    if (report.traffic.rows.empty()) return {};
    TextTable table = tables.make();
    const bool l3 = report.traffic.has_l3(), ratios = !report.baseline.empty();
    for (const char* name : {"L2->L1", "L3->L2", "DRAM"}) {
        if (!l3 && std::string_view(name) == "L3->L2") continue;
        // Where there is no room for all, the bytes between L2 and L3 go first, then all but the ratios.
        const bool middle = std::string_view(name) == "L3->L2";
        table.column(fmt::format("{} B/ray", name), Align::right, ratios ? (middle ? 2 : 1) : 0);
        if (ratios) table.column(fmt::format("{} ratio", name), Align::right);
    }
    for (std::size_t i = 0; i < report.rows.size(); ++i) {
        const Row& row = report.traffic.rows[i];
        std::vector<std::string> cells;
        const auto add = [&](const std::optional<Estimate>& bytes, const std::optional<Estimate>& ratio) {
            cells.push_back(with_interval(bytes));
            if (ratios) cells.push_back(tables.against_base(report.rows[i], ratio));
        };
        add(row.l2_bytes_per_ray, row.l2_bytes_ratio);
        if (l3) add(row.l3_bytes_per_ray, row.l3_bytes_ratio);
        add(row.dram_bytes_per_ray, row.dram_bytes_ratio);
        tables.add(table, report.rows[i], cells);
    }
    return '\n' + table.text(width);
}

std::string hits_table(const TimedReport& report, const Tables& tables, std::size_t width) {
    const bool three = std::any_of(report.rows.begin(), report.rows.end(),
                                   [](const TimedRow& row) { return row.totals.l3.requests() > 0; });
    TextTable table = tables.make();
    for (const char* level : {"L1", "L2", "L3"}) {
        if (!three && std::string_view(level) == "L3") break;
        table.column(fmt::format("{} %", level), Align::right);
        table.column("merged %", Align::right);
    }
    table.column("DRAM sectors", Align::right);
    for (const TimedRow& row : report.rows) {
        const TimedStatistics& t = row.totals;
        std::vector<std::string> cells;
        for (const LevelAnswers* level : {&t.l1, &t.l2, &t.l3}) {
            if (!three && level == &t.l3) break;
            cells.push_back(percent(hit_rate(*level, true)));
            cells.push_back(percent(ratio(static_cast<double>(level->merges), static_cast<double>(level->requests()))));
        }
        cells.push_back(fmt::format("{}", t.dram_sectors));
        tables.add(table, row, cells);
    }
    return table.text(width);
}

std::string use_table(const TimedReport& report, const Tables& tables, std::size_t width) {
    TextTable table = tables.make();
    for (const Named& r : resources) table.column(fmt::format("{} %", r.name), Align::right);
    for (const Named& r : parts) table.column(fmt::format("{} %", r.name), Align::right, 1);
    for (const TimedRow& row : report.rows) {
        std::vector<std::string> cells;
        for (const Named& r : resources) cells.push_back(percent(utilisation(row, r)));
        for (const Named& r : parts) cells.push_back(percent(utilisation(row, r)));
        tables.add(table, row, cells);
    }
    return table.text(width);
}

std::string rates_table(const TimedReport& report, const Tables& tables, std::size_t width) {
    TextTable table = tables.make();
    for (const char* title : {"L2 GB/s", "peak", "DRAM GB/s", "peak", "visit latency"})
        table.column(title, Align::right);
    for (const TimedRow& row : report.rows) {
        const TimedStatistics& t = row.totals;
        tables.add(table, row,
                   {decimals(l2_gb_s(row), 1), decimals(t.peak_l2_gb_s, 0), decimals(dram_gb_s(row), 1),
                    decimals(t.peak_dram_gb_s, 0), decimals(visit_latency(row), 0)});
    }
    return table.text(width);
}

std::string legend(const TimedReport& report) {
    return paragraph(
        "speed-up: cycles of " + (report.baseline.empty() ? std::string("a baseline") : report.baseline) +
        " over those of the row. occupancy: share of the slots for warps that is taken, on average. L1 %: hits of "
        "load requests, as Nsight Compute counts (l1tex__t_sector_hit_rate), requests for a sector on its way "
        "included; merged %: the share of all requests that are such. L2 %: the same of what L1 asks. B/ray and "
        "their ratios: counted by the functional replay, without time, of launches that begin with cold caches. % "
        "of "
        "a resource: of its time; L1 tags and L1 data are what the L1 port does, MSHRs registers for sectors on "
        "their way. L2 slices, L2 GB/s: of the level that all SMs share. visit latency: cycles from the first load "
        "of a visit to its last data. ±: half width of the 95 % confidence interval over sample indices.");
}

}  // namespace

std::string to_text(const TimedReport& report, std::size_t width) {
    const Tables tables(report);
    std::string text;
    text += times_table(report, tables, width) + traffic_table(report, tables, width) + '\n' +
            hits_table(report, tables, width) + '\n' + use_table(report, tables, width) + '\n' +
            rates_table(report, tables, width) + '\n' + legend(report);
    if (!report.traffic.rows.empty()) text += factor_table(report.traffic, width);
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
