// What the module of image_codec.hpp offers for drawing.hpp.
#pragma once

#include <memory>
#include <string>

#include "tracer/drawing.hpp"

namespace raycache::tracer {

class Painter {
public:
    virtual ~Painter() = default;
    virtual std::unique_ptr<Drawing> drawing(int width, int height) const = 0;
    /// Negative where the font is missing.
    virtual int text_width(const std::string&, int pixels_high) const = 0;
};

}  // namespace raycache::tracer
