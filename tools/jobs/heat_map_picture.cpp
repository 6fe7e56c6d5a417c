#include "tools/jobs/heat_map_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "tools/jobs/colour_scale.hpp"

namespace raycache::tools {

namespace {

constexpr int margin = 16;
constexpr unsigned smallest_panel = 384, largest_panel = 640;  ///< pixels of a panel's longer side, about
constexpr std::uint32_t block = 8;  ///< pixels on a side of the squares over which differences are averaged

struct Quantity {
    std::string title, unit, difference;
    const char* better;  ///< which colour of a difference is good for the caches
    std::vector<float> HeatMap::*values;
    double factor;  ///< from the map's unit to the shown one
    double lowest, highest;
};
constexpr double unlimited = std::numeric_limits<double>::infinity();

std::array<Quantity, 3> quantities_of(unsigned lanes) {
    const char *less = "blue: less, better", *more = "red: more, better";
    return {{{"DRAM bytes", "bytes per pixel and sample", "bytes", less, &HeatMap::dram_bytes, 1, 0, unlimited},
             {"L1 visit miss rate", "% of distinct sectors of visits", "percentage points", less,
              &HeatMap::l1_miss_rate, 100, 0, 100},
             {"active lanes", fmt::format("lanes per warp access, of {}", lanes), "lanes", more, &HeatMap::active_lanes,
              1, 1, static_cast<double>(lanes)}}};
}

/// A number by pixel; NaN where there is none.
struct Grid {
    std::uint32_t width, height;
    std::vector<double> values;

    double mean(std::uint32_t x, std::uint32_t y, std::uint32_t w, std::uint32_t h) const {
        double sum = 0;
        unsigned count = 0;
        for (std::uint32_t j = y; j < std::min(y + h, height); ++j)
            for (std::uint32_t i = x; i < std::min(x + w, width); ++i) {
                const double value = values[std::size_t{j} * width + i];
                if (std::isnan(value)) continue;
                sum += value;
                ++count;
            }
        return count ? sum / count : std::numeric_limits<double>::quiet_NaN();
    }
};

Grid grid_of(const HeatMap& map, const Quantity& quantity) {
    Grid grid{map.width, map.height, {}};
    for (const float value : map.*quantity.values) grid.values.push_back(quantity.factor * value);
    return grid;
}

/// Each pixel gets the mean difference of the square it lies in.
Grid difference(const Grid& base, const Grid& other) {
    Grid grid{base.width, base.height, std::vector<double>(base.values.size())};
    for (std::uint32_t y = 0; y < grid.height; y += block)
        for (std::uint32_t x = 0; x < grid.width; x += block) {
            const double d = other.mean(x, y, block, block) - base.mean(x, y, block, block);
            for (std::uint32_t j = y; j < std::min(y + block, grid.height); ++j)
                for (std::uint32_t i = x; i < std::min(x + block, grid.width); ++i)
                    grid.values[std::size_t{j} * grid.width + i] = d;
        }
    return grid;
}

Scale with_cuts(Scale scale, const std::vector<double>& values) {
    for (const double value : values) {  // NaN is neither
        scale.cut_low |= value < scale.low;
        scale.cut_high |= value > scale.high;
    }
    return scale;
}

Scale common_scale(const Quantity& quantity, const Grid& base, const Grid& other) {
    std::vector<double> both = base.values;
    both.insert(both.end(), other.values.begin(), other.values.end());
    double low = percentile(both, 0.01), high = percentile(both, 0.99);
    if (quantity.highest == unlimited) {
        low = 0;
        high = round_up(high);
    } else {  // a rate or a count of lanes: ends on even numbers
        low = std::max(quantity.lowest, std::floor(low / 2) * 2);
        high = std::min(quantity.highest, std::ceil(high / 2) * 2);
    }
    if (!(high > low)) high = low + 1;
    return with_cuts({low, high, viridis(), false, false}, both);
}

/// How many pixels of the picture a pixel of the map takes, or the other way round.
struct Zoom {
    Zoom(std::uint32_t width, std::uint32_t height) {
        const std::uint32_t side = std::max(width, height);
        enlarge = std::max(1u, (smallest_panel + side - 1) / side);
        reduce = std::max(1u, (side + largest_panel - 1) / largest_panel);
        panel_width = (width + reduce - 1) / reduce * enlarge;
        panel_height = (height + reduce - 1) / reduce * enlarge;
    }
    unsigned enlarge, reduce, panel_width, panel_height;
};

void draw_panel(tracer::Drawing& drawing, int x, int y, const Grid& grid, const Scale& scale, const Zoom& zoom) {
    std::vector<float> shares(std::size_t{zoom.panel_width} * zoom.panel_height);
    for (unsigned row = 0; row < zoom.panel_height; ++row)
        for (unsigned column = 0; column < zoom.panel_width; ++column) {
            float& share = shares[std::size_t{row} * zoom.panel_width + column];
            if (row % zoom.enlarge != 0)
                share = shares[std::size_t{row - 1} * zoom.panel_width + column];
            else if (column % zoom.enlarge != 0)
                share = shares[std::size_t{row} * zoom.panel_width + column - 1];
            else
                share = scale.share(grid.mean(column / zoom.enlarge * zoom.reduce, row / zoom.enlarge * zoom.reduce,
                                              zoom.reduce, zoom.reduce));
        }
    const auto width = static_cast<int>(zoom.panel_width), height = static_cast<int>(zoom.panel_height);
    drawing.map(x, y, width, shares, scale.colours);
    drawing.frame(x, y, width, height, {0, 0, 0});
}

}  // namespace

tracer::ScreenImage draw(const std::string& title, const HeatMap& base, const HeatMap& other) {
    const Zoom zoom(base.width, base.height);
    const auto panel_width = static_cast<int>(zoom.panel_width), panel_height = static_cast<int>(zoom.panel_height);
    const int panel = std::max(panel_width, 400);  // wide enough for its unit
    const int all_width = 3 * (panel + margin) - margin;
    const auto height = [](const std::vector<std::string>& lines) {
        return static_cast<int>(lines.size()) * label_line;
    };

    const auto title_lines = label_lines(title, all_width);
    const std::array row_titles{
        label_lines(base.name, all_width), label_lines(other.name, all_width),
        label_lines(fmt::format("{} minus {}, mean of {} x {} pixels", other.name, base.name, block, block),
                    all_width)};
    const auto footer = label_lines(
        "Scales end at about the 1st and 99th percentile of what they show; DRAM bytes begin at 0. <= and >=: values "
        "beyond have the colour of the end. Grey: nothing read.",
        all_width);

    const int bar = scale_bar_height + 3 * label_line + margin, heading = heading_size + margin;
    const int top = margin + height(title_lines) + heading + 4;
    std::array<int, 3> row_top{top, 0, 0}, panel_top{};
    for (std::size_t row = 0; row < 3; ++row) {
        panel_top[row] = row_top[row] + height(row_titles[row]);
        if (row < 2) row_top[row + 1] = panel_top[row] + panel_height + margin + (row == 1 ? bar : 0);
    }
    const int bottom = panel_top[2] + panel_height + margin + bar;
    const auto drawing = tracer::make_drawing(2 * margin + all_width, bottom + height(footer) + margin);
    const auto write = [&](int y, const std::vector<std::string>& lines) {
        for (const std::string& line : lines) {
            drawing->text(margin, y, line, label_size);
            y += label_line;
        }
    };
    write(margin, title_lines);
    for (std::size_t row = 0; row < 3; ++row) write(row_top[row], row_titles[row]);
    write(bottom, footer);

    int x = margin;
    for (const Quantity& quantity : quantities_of(base.lanes)) {
        const Grid grid = grid_of(base, quantity), other_grid = grid_of(other, quantity);
        const Grid change = difference(grid, other_grid);
        const Scale scale = common_scale(quantity, grid, other_grid),
                    change_scale = with_cuts(symmetric_scale(change.values), change.values);
        drawing->text(x, margin + height(title_lines) + 8, quantity.title, heading_size);
        const auto bar_top = [&](std::size_t row) { return panel_top[row] + panel_height + margin - 4; };
        draw_panel(*drawing, x, panel_top[0], grid, scale, zoom);
        draw_panel(*drawing, x, panel_top[1], other_grid, scale, zoom);
        draw_scale_bar(*drawing, x, bar_top(1), panel_width, scale, quantity.unit);
        draw_panel(*drawing, x, panel_top[2], change, change_scale, zoom);
        draw_scale_bar(*drawing, x, bar_top(2), panel_width, change_scale, quantity.difference);
        drawing->text(x + panel_width / 2, bar_top(2) + scale_bar_height + 4 + 2 * label_line, quantity.better,
                      label_size, tracer::TextAlign::centre);
        x += panel + margin;
    }
    return drawing->image();
}

}  // namespace raycache::tools
