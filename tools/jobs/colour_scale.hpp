// Which numbers a picture's colours stand for, the bar that says so, and the size of labels.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "tracer/drawing.hpp"

namespace raycache::tools {

/// Height of a label's letters, from one of its lines to the next, and of a heading: pixels.
inline constexpr int label_size = 17, label_line = 22, heading_size = 24;

/// Dark blue to yellow: "viridis" of matplotlib (S. van der Walt and N. Smith, 2015, public domain), 17 of its 256
/// colours.
std::span<const tracer::Colour> viridis();
/// Blue over white to red: "RdBu" of ColorBrewer (C. Brewer), its 11 colours as matplotlib has them.
std::span<const tracer::Colour> blue_white_red();

struct Scale {
    double low, high;
    std::span<const tracer::Colour> colours;  ///< from low to high
    bool cut_low = false, cut_high = false;   ///< whether values beyond an end have its colour

    /// 0 … 1 from low to high, as Drawing::map() takes it.
    float share(double value) const { return static_cast<float>((value - low) / (high - low)); }
};

/// The value that a share 0 … 1 of all values does not exceed; NaN values do not count; 0 if there is none.
double percentile(std::vector<double> values, double share);

/// The least of 1, 2, 3, 4, 5, 6, 8, 10 times a power of ten that is no less.
double round_up(double value);

/// Blue over white to red, from minus to plus a round number that 99 % of the sizes do not exceed.
Scale symmetric_scale(const std::vector<double>& values);

/// A bar of all colours with its ends and middle in numbers, and the unit below.
inline constexpr int scale_bar_height = 14;
void draw_scale_bar(tracer::Drawing&, int x, int y, int width, const Scale&, const std::string& unit);

/// The text in lines of at most `width` pixels as labels, broken between words, within a word only where it is longer.
std::vector<std::string> label_lines(const std::string&, int width);

}  // namespace raycache::tools
