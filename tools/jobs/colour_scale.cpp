#include "tools/jobs/colour_scale.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace raycache::tools {
namespace {

// clang-format off
constexpr std::array<tracer::Colour, 17> viridis_colours{{
    {68, 1, 84}, {72, 24, 106}, {71, 45, 123}, {66, 64, 134}, {59, 82, 139}, {51, 99, 141}, {44, 114, 142}, {38, 130, 142}, {33, 145, 140}, {31, 160, 136}, {40, 174, 128}, {63, 188, 115}, {94, 201, 98}, {132, 212, 75}, {173, 220, 48}, {216, 226, 25}, {253, 231, 37}}};
constexpr std::array<tracer::Colour, 11> rdbu_colours{{
    {5, 48, 97}, {32, 101, 171}, {67, 147, 195}, {144, 196, 221}, {209, 229, 240}, {247, 246, 246}, {253, 219, 199}, {243, 164, 129}, {214, 96, 77}, {177, 24, 43}, {103, 0, 31}}};
// clang-format on

std::string number(double value) { return fmt::format("{:.4g}", value == 0 ? 0 : value); }

/// As many of the letters as fit, at least one; whole characters of UTF-8.
std::size_t fitting(const std::string& word, int width) {
    std::size_t end = 0;
    do {
        std::size_t next = end + 1;
        while (next < word.size() && (static_cast<unsigned char>(word[next]) & 0xC0) == 0x80) ++next;
        if (end > 0 && tracer::text_width(word.substr(0, next), label_size) > width) break;
        end = next;
    } while (end < word.size());
    return end;
}

}  // namespace

std::span<const tracer::Colour> viridis() { return viridis_colours; }
std::span<const tracer::Colour> blue_white_red() { return rdbu_colours; }

double percentile(std::vector<double> values, double share) {
    std::erase_if(values, [](double v) { return std::isnan(v); });
    if (values.empty()) return 0;
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    return *at;
}

double round_up(double value) {
    if (!(value > 0)) return 1;
    const double power = std::pow(10, std::floor(std::log10(value)));
    for (const double step : {1., 2., 3., 4., 5., 6., 8.})
        if (step * power >= value * (1 - 1e-9)) return step * power;
    return 10 * power;
}

Scale symmetric_scale(const std::vector<double>& values) {
    std::vector<double> sizes;
    for (const double value : values) sizes.push_back(std::fabs(value));
    const double high = round_up(percentile(std::move(sizes), 0.99));
    return {-high, high, blue_white_red(), false, false};
}

void draw_scale_bar(tracer::Drawing& drawing, int x, int y, int width, const Scale& scale, const std::string& unit) {
    std::vector<float> shares;
    for (int row = 0; row < scale_bar_height; ++row)
        for (int i = 0; i < width; ++i) shares.push_back((static_cast<float>(i) + 0.5F) / static_cast<float>(width));
    drawing.map(x, y, width, shares, scale.colours);
    drawing.frame(x, y, width, scale_bar_height, {0, 0, 0});
    using tracer::TextAlign;
    const int below = y + scale_bar_height + 4, middle = x + width / 2;
    drawing.text(x, below, (scale.cut_low ? "<=" : "") + number(scale.low), label_size);
    drawing.text(middle, below, number((scale.low + scale.high) / 2), label_size, TextAlign::centre);
    drawing.text(x + width, below, (scale.cut_high ? ">=" : "") + number(scale.high), label_size, TextAlign::right);
    if (tracer::text_width(unit, label_size) <= width)
        drawing.text(middle, below + label_line, unit, label_size, TextAlign::centre);
    else
        drawing.text(x, below + label_line, unit, label_size);
}

std::vector<std::string> label_lines(const std::string& text, int width) {
    const auto fits = [&](const std::string& line) { return tracer::text_width(line, label_size) <= width; };
    std::vector<std::string> lines(1);
    std::size_t at = 0;
    while (at <= text.size()) {
        const std::size_t space = std::min(text.find(' ', at), text.size());
        std::string word = text.substr(at, space - at);
        at = space + 1;
        const std::string longer = lines.back().empty() ? word : lines.back() + ' ' + word;
        if (fits(longer)) {
            lines.back() = longer;
            continue;
        }
        if (!lines.back().empty()) lines.emplace_back();
        for (std::size_t end; (end = fitting(word, width)) < word.size(); lines.emplace_back()) {
            lines.back() = word.substr(0, end);
            word.erase(0, end);
        }
        lines.back() = word;
    }
    return lines;
}

}  // namespace raycache::tools
