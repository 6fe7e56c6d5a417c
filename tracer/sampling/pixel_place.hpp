// Where a pixel lies, for decorrelations that depend on it. A pixel's number is y * width + x.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <string>

#include "tracer/sampling/parameters.hpp"
#include "traces/error.hpp"

namespace raycache::tracer {

/// The m of m x m pixel classes: of every decorrelation that has them, and of the thread map `classes`.
inline constexpr std::uint32_t max_interleave = 256;
inline constexpr ParameterEntry interleave_parameter{.name = "interleave",
                                                     .description = "M of the M x M pixel classes",
                                                     .fallback = "8",
                                                     .label = "the M of M x M pixel classes",
                                                     .remedy = "give --interleave 8, the default",
                                                     .whole = true,
                                                     .least = 1,
                                                     .most = max_interleave};
inline std::uint32_t interleave_of(const Parameters& parameters) {
    return static_cast<std::uint32_t>(parameters.whole(interleave_parameter));
}

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
