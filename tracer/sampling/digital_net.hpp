// Digital nets in base 2: point i is the exclusive or of the direction numbers of the bits set in i.
// H. Niederreiter, "Random Number Generation and Quasi-Monte Carlo Methods", SIAM 1992, chapter 4.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <span>

namespace raycache::tracer {

/// Column k of one dimension's generator matrix, for bit k of the index; the digit after the point is the top bit.
using DirectionNumbers = std::array<std::uint32_t, 32>;

inline std::uint32_t digital_point(const DirectionNumbers& v, std::uint32_t index) {
    std::uint32_t x = 0;
    for (; index != 0; index &= index - 1) x ^= v[static_cast<unsigned>(std::countr_zero(index))];
    return x;
}

/// Whether the first 2^m points fall equally often into each cell that the leading bits[i] bits of the dimensions i make
/// together: if the first bits[i] rows of all their matrices, cut to m columns, are linearly independent over GF(2)
/// (Niederreiter 1992, theorem 4.28). It holds for every aligned block of 2^m points too, and after any nested uniform
/// scrambling. Precondition: m <= 32, as many bits as dimensions.
bool equal_cells(std::span<const DirectionNumbers> dimensions, std::span<const unsigned> bits, unsigned m);

}  // namespace raycache::tracer
