#include "tracer/sampling/measures/largest_hole.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "tracer/sampling/hash.hpp"
#include "tracer/sampling/measures/box_cover.hpp"
#include "traces/error.hpp"

namespace raycache::tracer {
namespace {

/// Whether an empty open square of this side has its lower left corner (a, b) in the cell. It is empty unless some
/// point lies in it, a < p.x < a + side; so the corners of squares that hold p are p.x - side < a < p.x. The largest
/// square touches points on two opposite sides, and can be slid until it does so in the other axis: integers suffice.
bool hole_in_cell(const BoxCover& cover, std::uint32_t cell, std::uint64_t side, CellBoxes& boxes) {
    if (side < 2) return true;
    cover.collect(cell, side - 1, side - 1, true, boxes);
    if (boxes.whole > 0) return false;
    return !for_each_piece(boxes, cover.cell_width(),
                           [](int count, std::uint64_t, std::uint64_t) { return count > 0; });
}

}  // namespace

std::uint64_t largest_hole(std::span<const FixedPoint2> points) {
    if (points.empty()) throw UsageError("largest hole of 0 points; expected at least 1");
    const BoxCover cover(points);
    // In random order only about log(cells) cells beat all before them; each of those takes a bisection.
    std::vector<std::uint32_t> order(cover.cells());
    std::iota(order.begin(), order.end(), 0);
    for (std::uint32_t i = cover.cells(); i > 1; --i) std::swap(order[i - 1], order[pcg4d({i, 0, 0, 0})[0] % i]);
    std::uint64_t best = 1;
    CellBoxes boxes;
    for (const std::uint32_t cell : order) {
        if (best == whole_circle || !hole_in_cell(cover, cell, best + 1, boxes)) continue;
        std::uint64_t low = best + 1, high = whole_circle + 1;  // a hole at low, none at high
        for (std::uint64_t reach = cover.cell_width(); low + reach < high; reach *= 2) {
            if (!hole_in_cell(cover, cell, low + reach, boxes)) {
                high = low + reach;
                break;
            }
            low += reach;
        }
        while (high - low > 1) {
            const std::uint64_t middle = low + (high - low) / 2;
            (hole_in_cell(cover, cell, middle, boxes) ? low : high) = middle;
        }
        best = low;
    }
    return best;
}

std::uint64_t largest_hole(std::span<const std::uint32_t> points) {
    if (points.empty()) throw UsageError("largest hole of 0 points; expected at least 1");
    std::vector<std::uint32_t> sorted(points.begin(), points.end());
    std::sort(sorted.begin(), sorted.end());
    std::uint64_t gap = whole_circle - sorted.back() + sorted.front();
    for (std::size_t i = 1; i < sorted.size(); ++i) gap = std::max<std::uint64_t>(gap, sorted[i] - sorted[i - 1]);
    return gap;
}

double hole_free_k(std::uint64_t side, std::uint64_t n, unsigned s) {
    return static_cast<double>(side) * 0x1p-32 * std::pow(static_cast<double>(n), 1.0 / s);
}

}  // namespace raycache::tracer
