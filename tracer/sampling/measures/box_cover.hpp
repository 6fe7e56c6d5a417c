// Equal squares laid on points of the torus [0,1)^2: which of them meet a small part of it, and how often each place is
// covered. What largest_hole.hpp and union_density.hpp have in common. Everything is an integer multiple of 2^-32 and
// exact; opposite sides of the unit square are joined.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "tracer/sampling/measures/star_discrepancy.hpp"

namespace raycache::tracer {

/// Values of one dimension, which runs from 0 to 1 and, its ends joined, is a circle.
inline constexpr std::uint64_t whole_circle = std::uint64_t{1} << 32;

/// [x0, x1) x [y0, y1), measured from the lower left corner of the cell it is clipped to.
struct CellBox {
    std::uint64_t x0, x1, y0, y1;
};

/// Boxes that meet one cell: those that cover all of it, counted, and the clipped rest.
struct CellBoxes {
    std::uint64_t whole = 0;
    std::vector<CellBox> parts;
};

class BoxCover {
public:
    /// Sorts the points into a grid of about one point per cell. The points must outlive this object.
    explicit BoxCover(std::span<const FixedPoint2> points);

    std::uint32_t cells() const { return side_ * side_; }
    std::uint64_t cell_width() const { return width_; }

    /// Boxes [p - left, p - left + length) in both axes, around every point p, where they meet the cell.
    /// `stop_at_whole`: the caller needs no more once one box covers the cell. Precondition: length <= 2^32.
    void collect(std::uint32_t cell, std::uint64_t left, std::uint64_t length, bool stop_at_whole, CellBoxes&) const;

private:
    struct Column;
    std::vector<Column> columns(std::uint32_t index, std::uint64_t left, std::uint64_t length) const;

    std::uint32_t side_ = 1;             ///< cells per axis, a power of two
    std::uint64_t width_;                ///< of a cell: 2^32 / side_
    std::vector<FixedPoint2> points_;    ///< by cell
    std::vector<std::uint32_t> starts_;  ///< first point of each cell, and the end
};

/// Cuts the cell into rectangles covered by equally many of `boxes.parts`; calls piece(count, width, height) for each,
/// `boxes.whole` not counted in. Returns false as soon as `piece` does.
template <class Piece>
bool for_each_piece(const CellBoxes& boxes, std::uint64_t cell_width, const Piece& piece) {
    struct Step {
        std::uint64_t y;
        int change;
    };
    thread_local std::vector<std::uint64_t> cuts;
    thread_local std::vector<Step> steps;
    cuts.assign({0, cell_width});
    for (const CellBox& b : boxes.parts) {
        cuts.push_back(b.x0);
        cuts.push_back(b.x1);
    }
    std::sort(cuts.begin(), cuts.end());
    cuts.erase(std::unique(cuts.begin(), cuts.end()), cuts.end());
    for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
        steps.clear();
        for (const CellBox& b : boxes.parts)
            if (b.x0 <= cuts[i] && b.x1 > cuts[i]) {
                steps.push_back({b.y0, 1});
                steps.push_back({b.y1, -1});
            }
        std::sort(steps.begin(), steps.end(), [](const Step& a, const Step& b) { return a.y < b.y; });
        std::uint64_t at = 0;
        int count = 0;
        for (const Step& step : steps) {
            if (step.y > at && !piece(count, cuts[i + 1] - cuts[i], step.y - at)) return false;
            at = step.y;
            count += step.change;
        }
        if (at < cell_width && !piece(count, cuts[i + 1] - cuts[i], cell_width - at)) return false;
    }
    return true;
}

}  // namespace raycache::tracer
