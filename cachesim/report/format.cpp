#include "cachesim/report/format.hpp"

#include <fmt/format.h>

#include <cmath>

#include "cachesim/report/table.hpp"
#include "traces/printable.hpp"

namespace raycache::cachesim {

namespace {

int about_four(double value, int small) {
    const double size = std::fabs(value);
    return size >= 1000 ? 0 : size >= 100 ? 1 : size >= 10 ? 2 : size >= 1 ? 3 : small;
}

}  // namespace

std::string decimals(double value, int digits) {
    return std::isfinite(value) ? fmt::format("{:.{}f}", value, digits) : undefined;
}

std::string figure(double value, int small) { return decimals(value, about_four(value, small)); }

std::string with_interval(const std::optional<Estimate>& e) {
    return e ? with_interval(e, about_four(e->mean, 3)) : undefined;
}

std::string with_interval(const std::optional<Estimate>& e, int digits) {
    return e ? decimals(e->mean, digits) + half_width_text(*e, digits) : undefined;
}

std::string half_width_text(const Estimate& e, int digits) {
    const std::string cell = half_width_cell(e, digits);
    return cell.empty() ? cell : ' ' + cell;
}

std::string half_width_cell(const Estimate& e, int digits) {
    return std::isfinite(e.mean) && e.half_width ? "±" + decimals(*e.half_width, digits) : "";
}

std::string paragraph(const std::string& text, std::size_t indent) {
    return break_lines(printable_line(text), text_width, indent) + '\n';
}

}  // namespace raycache::cachesim
