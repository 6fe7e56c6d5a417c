#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>
#include <sstream>

#include "cachesim/report/curve_report.hpp"
#include "cachesim/report/format.hpp"
#include "traces/memory_budget.hpp"

namespace raycache::cachesim {

namespace {

template <class Row>
std::string hit_cell(const LevelCurve& level, const Row& row, std::uint64_t at) {
    return decimals(100 * hit_rate(level, row, at).mean, 1);
}

/// Of the GPU's own sets: hit rate and bytes of every strategy, a row for each size.
std::string wide_table(const CurveReport& report, std::size_t l, std::size_t width) {
    const LevelCurve& first = report.series.front().levels[l];
    const CurveRow& own = first.rows.front();
    TextTable table;
    table.column("size", TextTable::Align::right);
    table.column("ways", TextTable::Align::right, 1);
    for (const CurveSeries& s : report.series)
        table.column(fmt::format("{} {} %", series_name(report, s), level_name(first.level)), TextTable::Align::right);
    for (const CurveSeries& s : report.series)
        table.column(fmt::format("{} {} B/ray", series_name(report, s), traffic_name(first.level, s.caches.levels)),
                     TextTable::Align::right);
    for (const std::uint64_t size : table_sizes(report, l)) {
        const std::uint64_t ways = size / own.way_bytes();
        std::vector<std::string> cells{size_text(size) + (ways == own.geometry.ways ? " *" : "  "),
                                       fmt::format("{}", ways)};
        for (const CurveSeries& s : report.series)
            cells.push_back(hit_cell(s.levels[l], s.levels[l].rows.front(), ways));
        for (const CurveSeries& s : report.series)
            cells.push_back(with_interval(ratio_of_totals(s.levels[l].bytes_per_ray(s.levels[l].rows.front(), ways))));
        table.row(std::move(cells));
    }
    return table.text(width);
}

/// The same, a row for each strategy and size.
std::string long_table(const CurveReport& report, std::size_t l, std::size_t width) {
    const LevelCurve& first = report.series.front().levels[l];
    const CurveRow& own = first.rows.front();
    TextTable table;
    table.column("strategy", TextTable::Align::left);
    table.column("size", TextTable::Align::right);
    table.column("ways", TextTable::Align::right, 1);
    table.column(level_name(first.level) + " %", TextTable::Align::right);
    table.column(traffic_name(first.level, report.series.front().caches.levels) + " B/ray", TextTable::Align::right);
    for (const CurveSeries& s : report.series)
        for (const std::uint64_t size : table_sizes(report, l)) {
            const std::uint64_t ways = size / own.way_bytes();
            const LevelCurve& level = s.levels[l];
            table.row({series_name(report, s), size_text(size) + (ways == own.geometry.ways ? " *" : "  "),
                       fmt::format("{}", ways), hit_cell(level, level.rows.front(), ways),
                       with_interval(ratio_of_totals(level.bytes_per_ray(level.rows.front(), ways)))});
        }
    return table.text(width);
}

std::string own_table(const CurveReport& report, std::size_t l, std::size_t width) {
    std::string wide = wide_table(report, l, width);
    std::istringstream lines(wide);
    for (std::string line; std::getline(lines, line);)
        if (width != any_width && columns_of(line) > width) return long_table(report, l, width);
    return wide;
}

/// Hit rates of all organisations.
std::string surface_table(const CurveReport& report, std::size_t l, std::size_t width) {
    const LevelCurve& first = report.series.front().levels[l];
    TextTable table;
    table.column("strategy", TextTable::Align::left);
    table.column("size", TextTable::Align::right);
    for (std::size_t r = 0; r < first.rows.size(); ++r)
        table.column(fmt::format("{} {} %", row_name(first, r), level_name(first.level)), TextTable::Align::right,
                     static_cast<unsigned>(r));
    for (const CurveSeries& s : report.series)
        for (const std::uint64_t size : table_sizes(report, l)) {
            std::vector<std::string> cells{series_name(report, s), size_text(size)};
            for (const CurveRow& row : s.levels[l].rows) {
                const std::uint64_t ways = size / row.way_bytes();
                const bool whole = ways > 0 && size % row.way_bytes() == 0;
                cells.push_back(whole ? hit_cell(s.levels[l], row, ways) : "-");
            }
            table.row(std::move(cells));
        }
    return table.text(width);
}

/// Hit rates of all policies, with the GPU's own sets.
std::string policy_table(const CurveReport& report, std::size_t l, std::size_t width) {
    const LevelCurve& first = report.series.front().levels[l];
    TextTable table;
    table.column("strategy", TextTable::Align::left);
    table.column("size", TextTable::Align::right);
    table.column(fmt::format("lru {} %", level_name(first.level)), TextTable::Align::right);
    for (const PolicyRow& row : first.policies)
        table.column(fmt::format("{} {} %", row.policy, level_name(first.level)), TextTable::Align::right);
    for (const CurveSeries& s : report.series) {
        const LevelCurve& level = s.levels[l];
        for (std::size_t at = 0; at < first.policies.front().ways.size(); ++at) {
            const std::uint64_t ways = first.policies.front().ways[at];
            std::vector<std::string> cells{series_name(report, s), size_text(ways * level.rows.front().way_bytes()),
                                           hit_cell(level, level.rows.front(), ways)};
            for (const PolicyRow& row : level.policies) cells.push_back(hit_cell(level, row, at));
            table.row(std::move(cells));
        }
    }
    return table.text(width);
}

}  // namespace

std::string to_text(const CurveReport& report, std::size_t width) {
    const CurveSeries& first = report.series.front();
    std::set<std::uint64_t> ns;
    std::uint64_t memory = 0;
    for (const CurveSeries& s : report.series) {
        ns.insert(s.spp);
        memory = std::max(memory, s.memory_bytes);
    }
    std::string text =
        paragraph(fmt::format("{}, N {}, {}, {} sample ind{}", first.scene, fmt::join(ns, ", "), first.gpu,
                              first.samples.size(), first.samples.size() == 1 ? "ex" : "ices"));
    for (std::size_t l = 0; l < first.levels.size(); ++l) {
        const LevelCurve& level = first.levels[l];
        const CacheGeometry& own = level.rows.front().geometry;
        text += '\n';
        text += paragraph(fmt::format("{} with lru by size, {}{} set{} of {}-byte lines; * is the GPU's own",
                                      level_name(level.level),
                                      own.slices > 1 ? fmt::format("{} slices of ", own.slices) : "", own.sets,
                                      own.sets == 1 ? "" : "s", own.line_bytes));
        text += '\n' + own_table(report, l, width);
        if (level.rows.size() > 1) text += '\n' + surface_table(report, l, width);
        if (!level.policies.empty()) text += '\n' + policy_table(report, l, width);
    }
    text += '\n';
    for (const Equivalent& e : report.equivalents) {
        text += paragraph(to_sentence(e) + '.', 2);
    }
    text +=
        paragraph(fmt::format("L1 %: hits of load requests, as Nsight Compute counts; below L1, hits of sectors asked "
                              "for. B/ray: fetched by the level, launches beginning with cold caches. ±: 95 % "
                              "confidence interval over sample indices. The curves of a launch took {}.",
                              size_text(memory)));
    for (const std::string& note : report.notes) text += paragraph("note: " + note, 2);
    return text;
}

}  // namespace raycache::cachesim
