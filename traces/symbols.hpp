// What the trace file says of a lane after each access: where it goes next (FORMAT.md, "Successors").
#pragma once

#include <cstdint>
#include <vector>

namespace raycache::traces {

/// Below these, a symbol is a depth: link s of the element just read, or a pop from the lane's stack.
namespace symbol {
inline constexpr std::uint8_t sequential = 0x80;  ///< next element of the same region; at a ray start: the root
inline constexpr std::uint8_t end_of_ray = 0x81;  ///< no further access in this ray
inline constexpr std::uint8_t literal = 0x82;     ///< spelled out
}  // namespace symbol

/// The highest stack that symbols can speak of.
inline constexpr unsigned symbol_stack_entries = 64;

/// The symbols of a warp: one per lane of each record, ray starts included, in the order of the records.
using WarpSymbols = std::vector<std::uint8_t>;

}  // namespace raycache::traces
