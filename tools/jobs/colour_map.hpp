// Numbers to colours in which equal steps look equal.
#pragma once

#include <array>
#include <cstdint>

namespace raycache::tools {

using Colour = std::array<std::uint8_t, 3>;  ///< sRGB

/// 0 … 1, dark blue to yellow: "viridis" of matplotlib (S. van der Walt and N. Smith, 2015, public domain), linear
/// between 17 of its 256 colours. Values outside are cut; NaN is grey.
Colour viridis(double value);

/// -1 … 1, blue over white to red: "RdBu" of ColorBrewer (C. Brewer), its 11 colours as matplotlib has them.
Colour blue_white_red(double value);

inline constexpr Colour no_value{128, 128, 128};

}  // namespace raycache::tools
