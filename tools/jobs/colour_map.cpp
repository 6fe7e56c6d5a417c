#include "tools/jobs/colour_map.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace raycache::tools {

namespace {

constexpr std::array<Colour, 17> viridis_colours{{{68, 1, 84},
                                                  {72, 24, 106},
                                                  {71, 45, 123},
                                                  {66, 64, 134},
                                                  {59, 82, 139},
                                                  {51, 99, 141},
                                                  {44, 114, 142},
                                                  {38, 130, 142},
                                                  {33, 145, 140},
                                                  {31, 160, 136},
                                                  {40, 174, 128},
                                                  {63, 188, 115},
                                                  {94, 201, 98},
                                                  {132, 212, 75},
                                                  {173, 220, 48},
                                                  {216, 226, 25},
                                                  {253, 231, 37}}};
constexpr std::array<Colour, 11> rdbu_colours{{{5, 48, 97},
                                               {32, 101, 171},
                                               {67, 147, 195},
                                               {144, 196, 221},
                                               {209, 229, 240},
                                               {247, 246, 246},
                                               {253, 219, 199},
                                               {243, 164, 129},
                                               {214, 96, 77},
                                               {177, 24, 43},
                                               {103, 0, 31}}};

Colour between(std::span<const Colour> colours, double value) {
    if (std::isnan(value)) return no_value;
    const double at = std::clamp(value, 0.0, 1.0) * static_cast<double>(colours.size() - 1);
    const auto first = std::min(static_cast<std::size_t>(at), colours.size() - 2);
    const double rest = at - static_cast<double>(first);
    Colour mixed;
    for (std::size_t c = 0; c < 3; ++c)
        mixed[c] =
            static_cast<std::uint8_t>(std::lround((1 - rest) * colours[first][c] + rest * colours[first + 1][c]));
    return mixed;
}

}  // namespace

Colour viridis(double value) { return between(viridis_colours, value); }
Colour blue_white_red(double value) { return between(rdbu_colours, (value + 1) / 2); }

}  // namespace raycache::tools
