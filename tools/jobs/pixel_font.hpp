// The usual 5 x 7 dot-matrix characters, so that a picture can be labelled on any machine, without a font file.
#pragma once

#include <array>
#include <cstdint>

namespace raycache::tools {

/// Cells of a character, gaps to its neighbours included.
inline constexpr unsigned glyph_width = 6, glyph_height = 9;

/// Five columns of a character, from the left; bit 0 is the topmost of eight rows. Printable ASCII; others show '?'.
const std::array<std::uint8_t, 5>& glyph(char);

}  // namespace raycache::tools
