#include "cachesim/report/waterfall.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace raycache::cachesim {

namespace {

/// A line of cells of one character each.
class Line {
public:
    explicit Line(std::size_t cells) : cells_(cells, " ") {}
    void set(std::size_t at, const char* character) { cells_[at] = character; }
    void write(std::size_t at, const std::string& ascii) {
        for (std::size_t i = 0; i < ascii.size() && at + i < cells_.size(); ++i) cells_[at + i] = ascii.substr(i, 1);
    }
    std::string text() const {
        std::string all;
        for (const std::string& cell : cells_) all += cell;
        all.erase(all.find_last_not_of(' ') + 1);
        return all;
    }

private:
    std::vector<std::string> cells_;
};

}  // namespace

std::string waterfall(const std::vector<WaterfallStep>& steps, std::size_t columns) {
    std::size_t name_width = 0;
    double product = 1, low = 1, high = 1;
    for (const WaterfallStep& step : steps) {
        name_width = std::max(name_width, step.name.size());
        if (!step.subtotal) product *= step.factor;
        low = std::min(low, product);
        high = std::max(high, product);
    }
    const std::size_t left = name_width + 9;  // name, two spaces, "x0.123", a space
    const std::size_t cells = columns - left;
    const double range = std::max(std::log(high / low), 1e-9);
    const auto cell = [&](double value) {
        return static_cast<std::size_t>(std::lround(std::log(value / low) / range * static_cast<double>(cells - 1)));
    };

    Line axis(cells);
    const std::string low_label = fmt::format("x{:.2f}", low), high_label = fmt::format("x{:.2f}", high);
    if (cell(1) > low_label.size()) axis.write(0, low_label);
    if (high > 1 + 1e-9 && cell(1) + 3 + high_label.size() < cells) axis.write(cells - high_label.size(), high_label);
    axis.write(std::min(cell(1), cells - 2), "x1");
    std::string text = std::string(left, ' ') + axis.text() + '\n';

    product = 1;
    for (const WaterfallStep& step : steps) {
        const double from = step.subtotal ? 1 : product;
        if (!step.subtotal) product *= step.factor;
        Line line(cells);
        line.set(cell(1), "│");
        const std::size_t begin = cell(from), end = cell(product);
        for (std::size_t at = std::min(begin, end); at < std::max(begin, end); ++at)
            line.set(at, step.subtotal ? "▒" : "█");
        if (begin == end)
            line.set(begin, "│");
        else
            line.set(end < begin ? end : end - 1, end < begin ? "◄" : "►");
        text += fmt::format("{:<{}}  x{:.3f} {}\n", step.name, name_width, step.subtotal ? product : step.factor,
                            line.text());
    }
    return text;
}

}  // namespace raycache::cachesim
