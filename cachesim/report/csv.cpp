#include <initializer_list>

#include "cachesim/report/cold_launches.hpp"
#include "cachesim/report/csv_line.hpp"
#include "cachesim/report/report.hpp"
#include "cachesim/report/verdict.hpp"

namespace raycache::cachesim {

namespace {

/// The last columns are there only if some GPU has an L3, or some trace is of a wavefront.
constexpr std::initializer_list<Presence> parts = {Presence::always, Presence::three_levels, Presence::wavefront};

/// Calls use(figure, place in the list) for the figures of a part.
template <class Use>
void for_each_figure(Presence part, const Use& use) {
    for (std::size_t i = 0; i < std::size(traffic_figures); ++i)
        if (traffic_figures[i].presence == part && traffic_figures[i].in_csv()) use(traffic_figures[i], i);
}

}  // namespace

std::string to_csv(const Report& report) {
    CsvLine header;
    add_titles_of_names(header);
    for (const Presence part : parts) {
        if (!report.has(part)) continue;
        for_each_figure(part, [&](const TrafficFigure& figure, std::size_t) { add_title(header, figure); });
        if (part == Presence::always)
            for (const char* title : {"verdict_level", "verdict"}) header.text(title);
    }
    const std::size_t levels = report.has_l3() ? 3 : 2;
    if (!report.cold.empty()) add_cold_titles(header, levels, false);
    std::string csv = header.end();
    for (std::size_t n = 0; n < report.rows.size(); ++n) {
        const Row& row = report.rows[n];
        CsvLine line;
        add_names(line, row);
        for (const Presence part : parts) {
            if (!report.has(part)) continue;
            for_each_figure(part, [&](const TrafficFigure& figure, std::size_t i) {
                if (figure.of == Of::total)
                    line.number(figure.total(row.totals, row.caches));
                else
                    add_figure(line, figure, row.figures[i]);
            });
            if (part != Presence::always) continue;
            const Verdict found = row["dram_bytes_ratio"] ? verdict(difference_of(row)) : Verdict{};
            line.text(found.level.value_or(""));
            line.text(found.text);
        }
        if (!report.cold.empty()) add_cold_fields(line, report.cold[n], levels, false);
        csv += line.end();
    }
    return csv;
}

}  // namespace raycache::cachesim
