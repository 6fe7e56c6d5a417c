// How reports write numbers and break lines.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "cachesim/report/report.hpp"

namespace raycache::cachesim {

/// What a figure shows that is no number: a quotient of nothing.
inline constexpr const char* undefined = "-";
/// What a table that shows one says of it.
inline constexpr const char* undefined_legend = "-: undefined, since it would be divided by nothing.\n";

/// `undefined` for what is no number.
std::string decimals(double value, int digits);

/// About four digits: "1334", "201.3", "20.13", "2.013", "0.201"; "0.2013" with small = 4.
std::string figure(double value, int small = 3);

/// "1334 ±201": the mean with about four digits, and the half width to the same place.
std::string with_interval(const std::optional<Estimate>&);
/// "0.861 ±0.073": both with that number of decimals.
std::string with_interval(const std::optional<Estimate>&, int digits);
/// " ±0.073", or nothing where there is no interval.
std::string half_width_text(const Estimate&, int digits);
/// "±0.073" for a line below the mean, or nothing.
std::string half_width_cell(const Estimate&, int digits);

/// A figure in a column of its own.
template <class Figure>
std::string figure_cell(const Figure& figure, const std::optional<Estimate>& value) {
    if (!value) return undefined;
    if (!figure.interval && figure.digits == about_four_digits) return cachesim::figure(figure.scale * value->mean);
    if (!figure.interval) return decimals(figure.scale * value->mean, figure.digits);
    return figure.digits == about_four_digits ? with_interval(value) : with_interval(value, figure.digits);
}

/// A paragraph of lines of at most text_width columns, the second and later ones indented; ends in '\n'.
std::string paragraph(const std::string& text, std::size_t indent = 0);

}  // namespace raycache::cachesim
