// Morton codes (G. M. Morton, "A computer oriented geodetic data base", 1966): the bits of three cell numbers
// interleaved, so that close codes are mostly close cells. Of each triple of bits, x is the highest.
#pragma once

#include <algorithm>
#include <cstdint>

#include "tracer/vec.hpp"

namespace raycache::tracer {

struct Cell {
    std::uint32_t x = 0, y = 0, z = 0;
    bool operator==(const Cell&) const = default;
};

/// Moves bit i of a number below 2^10 to bit 3i.
constexpr std::uint32_t spread_bits(std::uint32_t v) {
    v = (v | v << 16) & 0x030000ff;
    v = (v | v << 8) & 0x0300f00f;
    v = (v | v << 4) & 0x030c30c3;
    return (v | v << 2) & 0x09249249;
}

/// Of cell numbers below 2^10.
constexpr std::uint32_t morton_code(const Cell& c) {
    return spread_bits(c.x) << 2 | spread_bits(c.y) << 1 | spread_bits(c.z);
}

/// floor(u * cells), with u clamped to [0, 1]; u = 1 and all above are the last cell, NaN is the first.
inline std::uint32_t cell_of(float u, std::uint32_t cells) {
    if (!(u > 0)) return 0;
    return std::min(static_cast<std::uint32_t>(std::min(u, 1.0F) * static_cast<float>(cells)), cells - 1);
}

/// A regular grid of cells^3 over a box. Axes without extent have cell 0.
class CellGrid {
public:
    CellGrid(const Box& bounds, std::uint32_t cells) : lower_(bounds.lower), cells_(cells) {
        const Vec3 size = bounds.upper - bounds.lower;
        per_size_ = {inverse(size.x), inverse(size.y), inverse(size.z)};
    }
    Cell operator()(Vec3 p) const {
        const Vec3 u = (p - lower_) * per_size_;
        return {cell_of(u.x, cells_), cell_of(u.y, cells_), cell_of(u.z, cells_)};
    }

private:
    static float inverse(float size) { return size > 0 ? 1 / size : 0; }

    Vec3 lower_, per_size_;
    std::uint32_t cells_;
};

/// A direction, of any length but zero, as a cell of the cube [-1, 1]^3.
inline Cell direction_cell(Vec3 direction, std::uint32_t cells) {
    const Vec3 u = (normalize(direction) + Vec3{1, 1, 1}) * 0.5F;
    return {cell_of(u.x, cells), cell_of(u.y, cells), cell_of(u.z, cells)};
}

/// Signs of a direction: 4 for x < 0, 2 for y < 0, 1 for z < 0.
inline std::uint32_t octant(Vec3 d) {
    return static_cast<std::uint32_t>(d.x < 0) << 2 | static_cast<std::uint32_t>(d.y < 0) << 1 |
           static_cast<std::uint32_t>(d.z < 0);
}

}  // namespace raycache::tracer
