// Which numbers a picture's colours stand for, and the bar that says so.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tools/jobs/canvas.hpp"
#include "tools/jobs/colour_map.hpp"
#include "tools/jobs/pixel_font.hpp"

namespace raycache::tools {

struct Scale {
    double low, high;
    std::function<Colour(double share)> colour;  ///< of 0 … 1 from low to high
    bool cut_low = false, cut_high = false;      ///< whether values beyond an end have its colour

    Colour of(double value) const { return colour((value - low) / (high - low)); }
};

/// The value that a share 0 … 1 of all values does not exceed; NaN values do not count; 0 if there is none.
double percentile(std::vector<double> values, double share);

/// The least of 1, 2, 3, 4, 5, 6, 8, 10 times a power of ten that is no less.
double round_up(double value);

/// Blue over white to red, from minus to plus a round number that 99 % of the sizes do not exceed.
Scale symmetric_scale(const std::vector<double>& values);

/// A bar of all colours with its ends and middle in numbers, and the unit below.
struct ScaleBar {
    static constexpr unsigned height = 14, text_scale = 2, line = glyph_height * text_scale + 4;
    static void draw(Canvas&, unsigned x, unsigned y, unsigned width, const Scale&, const std::string& unit);
};

}  // namespace raycache::tools
