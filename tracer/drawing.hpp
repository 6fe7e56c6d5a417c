// Pictures with labels: text, frames, maps of numbers in colours. OpenImageIO draws them, in the module of
// image_codec.hpp; text is set in DejaVu Sans, so that a picture is the same on every machine.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "tracer/image.hpp"

namespace raycache::tracer {

using Colour = std::array<std::uint8_t, 3>;  ///< sRGB

inline constexpr Colour no_value{128, 128, 128};  ///< grey: of a number that is none

enum class TextAlign { left, centre, right };

/// Coordinates are pixels from the upper left corner. What lies outside the picture is left out.
class Drawing {
public:
    virtual ~Drawing() = default;

    /// One line of UTF-8 in black. (x, y): top of the line, at its left end, middle or right end.
    virtual void text(int x, int y, const std::string&, int pixels_high, TextAlign = TextAlign::left) = 0;
    /// An outline, one pixel thick, inside of the rectangle.
    virtual void frame(int x, int y, int width, int height, Colour) = 0;
    /// Another picture, (x, y): where its corner goes.
    virtual void paste(int x, int y, const ScreenImage&) = 0;
    /// Numbers by pixel as colours: 0 … 1 from the first to the last of `colours`, linear between neighbours; what is
    /// beyond has the colour of the end, NaN `no_value`. `shares`: width numbers a row.
    virtual void map(int x, int y, int width, std::span<const float> shares, std::span<const Colour> colours) = 0;

    virtual ScreenImage image() const = 0;
};

/// White. Throws Error where the module or the font cannot be found.
std::unique_ptr<Drawing> make_drawing(int width, int height);

/// Size of one line of text, in pixels. Throws Error as make_drawing() does.
int text_width(const std::string&, int pixels_high);

/// Throws Error where make_drawing() would: call it before work that ends in a picture.
void check_drawing();

}  // namespace raycache::tracer
