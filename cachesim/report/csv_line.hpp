// One record of comma-separated values.
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <cstdint>
#include <optional>
#include <string>

#include "cachesim/report/csv_field.hpp"
#include "cachesim/report/report.hpp"

namespace raycache::cachesim {

/// Lines end in '\n'. A value that does not exist is an empty field.
class CsvLine {
public:
    void text(const std::string& value) { raw(csv_field(value)); }
    void number(std::uint64_t value) { raw(fmt::format("{}", value)); }
    /// The shortest digits that read back as the same double.
    void number(double value) { raw(std::isfinite(value) ? fmt::format("{}", value) : ""); }
    /// Mean and half width: two fields.
    void estimate(const std::optional<Estimate>& e) {
        const double none = std::nan("");
        number(e ? e->mean : none);
        number(e && e->half_width ? *e->half_width : none);
    }
    std::string end() { return line_ + '\n'; }

private:
    void raw(const std::string& field) {
        if (!first_) line_ += ',';
        first_ = false;
        line_ += field;
    }
    std::string line_;
    bool first_ = true;
};

/// A figure and its title: the number alone, or mean and half width.
template <class Figure>
void add_figure(CsvLine& line, const Figure& figure, const std::optional<Estimate>& value) {
    if (figure.has_interval())
        line.estimate(value);
    else
        line.number(value ? value->mean : std::nan(""));
}
template <class Figure>
void add_title(CsvLine& line, const Figure& figure) {
    line.text(figure.key);
    if (figure.has_interval()) line.text(std::string(figure.key) + "_ci95");
}

/// What a row is of.
inline void add_titles_of_names(CsvLine& line) {
    for (const char* title :
         {"scene", "strategy", "sequence", "parameters", "thread_map", "gpu", "group", "spp", "samples"})
        line.text(title);
}
inline void add_names(CsvLine& line, const Row& row) {
    for (const auto* name :
         {&row.scene, &row.strategy, &row.sequence, &row.parameters, &row.thread_map, &row.gpu, &row.group})
        line.text(*name);
    line.number(row.spp);
    line.text(fmt::format("{}", fmt::join(row.samples, " ")));  // one field: "0 1 2"
}

}  // namespace raycache::cachesim
