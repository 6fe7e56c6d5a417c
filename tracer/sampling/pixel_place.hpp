// Where a pixel lies, for decorrelations that depend on it. A pixel's number is y * width + x.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <string>

#include "traces/error.hpp"

namespace raycache::tracer {

struct PixelPlace {
    std::uint32_t x = 0, y = 0;
};

class PixelPlaces {
public:
    /// Throws UsageError where the width is not known.
    PixelPlaces(const std::string& decorrelation, std::uint32_t width) : width_(width) {
        if (width == 0)
            throw UsageError(
                fmt::format("sampling: {} depends on where a pixel lies, so the picture's width must be 1 or more, "
                            "found 0: say how "
                            "wide the picture is",
                            decorrelation));
    }
    PixelPlace of(std::uint32_t pixel) const { return {pixel % width_, pixel / width_}; }

    /// (x mod m, y mod m) as a number below m * m.
    std::uint32_t class_of(std::uint32_t pixel, std::uint32_t m) const {
        const PixelPlace p = of(pixel);
        return p.y % m * m + p.x % m;
    }

private:
    std::uint32_t width_;
};

}  // namespace raycache::tracer
