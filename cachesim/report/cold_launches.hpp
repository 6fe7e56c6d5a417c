// Launches from cold caches in a report of the steady state: their figures, and how each form shows them.
#pragma once

#include <string>
#include <vector>

#include "cachesim/report/cold_figures.hpp"
#include "cachesim/report/csv_line.hpp"
#include "cachesim/report/json_parts.hpp"
#include "cachesim/report/report.hpp"
#include "cachesim/report/timed_report.hpp"

namespace raycache::cachesim {

/// Of each series, in the same order; none where `launches` is empty. `steady` and `times`: the estimates from windows,
/// series by series; `times` may be empty.
std::vector<ColdFigures> cold_figures(const std::vector<ColdLaunches>& launches, const std::vector<Series>& steady,
                                      const std::vector<TimedSeries>& times, const Baseline&);

/// Tables with a title and a legend, a line for each row; nothing where the report has no such launches.
std::string cold_tables(const Report&, std::size_t width);
std::string cold_tables(const TimedReport&, std::size_t width);

/// The value of "cold_launches" in a row.
Json cold_json(const ColdFigures&);

/// The last columns of a CSV. `levels`: the most that a GPU of the report has; `timed`: the report is one in time.
void add_cold_titles(CsvLine&, std::size_t levels, bool timed);
void add_cold_fields(CsvLine&, const ColdFigures&, std::size_t levels, bool timed);

}  // namespace raycache::cachesim
