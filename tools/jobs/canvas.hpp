// A picture to draw on: rectangles and labels, nothing else.
#pragma once

#include <string>
#include <vector>

#include "tools/jobs/colour_map.hpp"
#include "tracer/image.hpp"

namespace raycache::tools {

class Canvas {
public:
    /// White.
    Canvas(unsigned width, unsigned height);

    /// What lies outside the canvas is left out.
    void fill(unsigned x, unsigned y, unsigned width, unsigned height, Colour);
    void outline(unsigned x, unsigned y, unsigned width, unsigned height, Colour);
    /// Black letters; (x, y) is the upper left corner, each dot is a square of `scale` pixels.
    void text(unsigned x, unsigned y, const std::string&, unsigned scale);

    static unsigned text_width(const std::string&, unsigned scale);
    /// The text in lines of at most `width` pixels, broken between words, within a word only where it is longer.
    static std::vector<std::string> lines(const std::string&, unsigned scale, unsigned width);

    const tracer::ScreenImage& image() const { return image_; }

private:
    tracer::ScreenImage image_;
};

}  // namespace raycache::tools
