#include "tools/heat_map_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>

#include "tools/canvas.hpp"
#include "tools/colour_scale.hpp"
#include "tools/pixel_font.hpp"

namespace raycache::tools {

namespace {

constexpr unsigned margin = 16, bar_height = ScaleBar::height, text_scale = ScaleBar::text_scale, line = ScaleBar::line;
constexpr unsigned smallest_panel = 384, largest_panel = 640;  ///< pixels of a panel's longer side, about
constexpr std::uint32_t block = 8;  ///< pixels on a side of the squares over which differences are averaged

struct Quantity {
    const char *title, *unit, *difference;
    std::vector<float> HeatMap::*values;
    double factor;  ///< from the map's unit to the shown one
    double lowest, highest;
};
constexpr double unlimited = std::numeric_limits<double>::infinity();
constexpr std::array<Quantity, 3> quantities{{
    {"DRAM bytes", "bytes per pixel and sample", "bytes", &HeatMap::dram_bytes, 1, 0, unlimited},
    {"L1 miss rate", "% of sectors asked for", "percentage points", &HeatMap::l1_miss_rate, 100, 0, 100},
    {"active lanes", "lanes per warp access, of 32", "lanes", &HeatMap::active_lanes, 1, 1, 32},
}};

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
    return {low, high, viridis};
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

void draw_panel(Canvas& canvas, unsigned x, unsigned y, const Grid& grid, const Scale& scale, const Zoom& zoom) {
    for (unsigned row = 0; row * zoom.enlarge < zoom.panel_height; ++row)
        for (unsigned column = 0; column * zoom.enlarge < zoom.panel_width; ++column) {
            const double value = grid.mean(column * zoom.reduce, row * zoom.reduce, zoom.reduce, zoom.reduce);
            canvas.fill(x + column * zoom.enlarge, y + row * zoom.enlarge, zoom.enlarge, zoom.enlarge,
                        std::isnan(value) ? no_value : scale.colour((value - scale.low) / (scale.high - scale.low)));
        }
    canvas.outline(x, y, zoom.panel_width, zoom.panel_height, {0, 0, 0});
}

}  // namespace

tracer::ScreenImage draw(const std::string& title, const HeatMap& base, const HeatMap& other) {
    const Zoom zoom(base.width, base.height);
    const unsigned panel = std::max(zoom.panel_width, 400u);  // wide enough for its unit
    const unsigned row_height = line + zoom.panel_height + margin, bar = bar_height + 2 * line + margin;
    const unsigned heading = 3 * glyph_height + margin, top = margin + line + heading + 4;
    Canvas canvas(margin + 3 * (panel + margin), top + 3 * row_height + 2 * bar);
    canvas.text(margin, margin, title, text_scale);

    const std::array<std::string, 3> titles{base.name, other.name,
                                            fmt::format("{} minus {}, mean of {} x {} pixels; blue: {} has less",
                                                        other.name, base.name, block, block, other.name)};
    const std::array<unsigned, 3> row_top{top, top + row_height, top + 2 * row_height + bar};
    for (unsigned row = 0; row < 3; ++row) canvas.text(margin, row_top[row], titles[row], text_scale);
    for (unsigned column = 0; column < quantities.size(); ++column) {
        const Quantity& quantity = quantities[column];
        const unsigned x = margin + column * (panel + margin);
        const Grid grid = grid_of(base, quantity), other_grid = grid_of(other, quantity);
        const Grid change = difference(grid, other_grid);
        const Scale scale = common_scale(quantity, grid, other_grid), change_scale = symmetric_scale(change.values);
        canvas.text(x, margin + line + 8, quantity.title, 3);
        draw_panel(canvas, x, row_top[0] + line, grid, scale, zoom);
        draw_panel(canvas, x, row_top[1] + line, other_grid, scale, zoom);
        ScaleBar::draw(canvas, x, row_top[1] + row_height - 4, zoom.panel_width, scale, quantity.unit);
        draw_panel(canvas, x, row_top[2] + line, change, change_scale, zoom);
        ScaleBar::draw(canvas, x, row_top[2] + row_height - 4, zoom.panel_width, change_scale, quantity.difference);
    }
    return canvas.image();
}

}  // namespace raycache::tools
