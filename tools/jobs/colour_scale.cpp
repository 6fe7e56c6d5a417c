#include "tools/jobs/colour_scale.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace raycache::tools {
namespace {

std::string number(double value) { return fmt::format("{:.4g}", value == 0 ? 0 : value); }

}  // namespace

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
    return {-high, high, [](double share) { return blue_white_red(2 * share - 1); }, false, false};
}

void ScaleBar::draw(Canvas& canvas, unsigned x, unsigned y, unsigned width, const Scale& scale,
                    const std::string& unit) {
    for (unsigned i = 0; i < width; ++i) canvas.fill(x + i, y, 1, height, scale.colour((i + 0.5) / width));
    canvas.outline(x, y, width, height, {0, 0, 0});
    const std::string low = (scale.cut_low ? "<=" : "") + number(scale.low),
                      middle = number((scale.low + scale.high) / 2),
                      high = (scale.cut_high ? ">=" : "") + number(scale.high);
    const unsigned below = y + height + 4;
    canvas.text(x, below, low, text_scale);
    canvas.text(x + (width - Canvas::text_width(middle, text_scale)) / 2, below, middle, text_scale);
    canvas.text(x + width - Canvas::text_width(high, text_scale), below, high, text_scale);
    canvas.text(x + (width - std::min(width, Canvas::text_width(unit, text_scale))) / 2, below + line, unit,
                text_scale);
}

}  // namespace raycache::tools
