#include "tracer/sampling/measures/box_cover.hpp"

#include <bit>

namespace raycache::tracer {
namespace {

/// An interval of the circle where it meets a cell that starts at 0 and is `width` wide: up to two pieces.
struct Pieces {
    unsigned count = 0;
    std::uint64_t from[2]{}, to[2]{};

    /// The interval starts at `start` (seen from the cell) and is `length` long.
    Pieces(std::uint32_t start, std::uint64_t length, std::uint64_t width) {
        const std::uint64_t end = start + length;
        if (start < width && length > 0) add(start, std::min(end, width));
        if (end > whole_circle) add(0, std::min(end - whole_circle, width));
    }
    bool covers(std::uint64_t width) const { return count == 1 && from[0] == 0 && to[0] == width; }

private:
    void add(std::uint64_t a, std::uint64_t b) {
        from[count] = a;
        to[count++] = b;
    }
};

}  // namespace

/// A column (or row) of cells whose points have boxes that meet the cell in question.
struct BoxCover::Column {
    std::uint32_t index;
    bool whole;  ///< the boxes of all its points reach across the cell
};

BoxCover::BoxCover(std::span<const FixedPoint2> points) {
    while (std::uint64_t{side_} * side_ * 4 <= points.size() && side_ < (1U << 12)) side_ *= 2;
    if (std::uint64_t{side_} * side_ * 2 <= points.size()) side_ *= 2;
    width_ = whole_circle / side_;
    const auto cell_of = [&](const FixedPoint2& p) {
        return static_cast<std::uint32_t>(p.y / width_ * side_ + p.x / width_);
    };
    starts_.assign(std::size_t{cells()} + 1, 0);
    for (const FixedPoint2& p : points) ++starts_[cell_of(p) + 1];
    for (std::size_t c = 0; c < cells(); ++c) starts_[c + 1] += starts_[c];
    std::vector<std::uint32_t> next(starts_.begin(), starts_.end() - 1);
    points_.resize(points.size());
    for (const FixedPoint2& p : points) points_[next[cell_of(p)]++] = p;
}

std::vector<BoxCover::Column> BoxCover::columns(std::uint32_t index, std::uint64_t left, std::uint64_t length) const {
    const auto width = static_cast<std::int64_t>(width_), l = static_cast<std::int64_t>(left),
               n = static_cast<std::int64_t>(length), origin = index * width;
    // Points whose boxes meet the cell: origin + left - length < p < origin + left + width.
    const std::int64_t low = origin + l - n + 1, high = origin + l + width - 1;
    const auto floor_divide = [width](std::int64_t a) { return a >= 0 ? a / width : -((-a + width - 1) / width); };
    const std::int64_t first = floor_divide(low), last = std::min(floor_divide(high), first + side_ - 1);
    std::vector<Column> found;
    for (std::int64_t c = first; c <= last; ++c) {
        const bool whole = c * width >= low + width - 1 && (c + 1) * width - 1 <= origin + l;
        found.push_back({static_cast<std::uint32_t>(c & (side_ - 1)), whole});
    }
    std::stable_partition(found.begin(), found.end(), [](const Column& c) { return c.whole; });
    return found;
}

void BoxCover::collect(std::uint32_t cell, std::uint64_t left, std::uint64_t length, bool stop_at_whole,
                       CellBoxes& boxes) const {
    boxes.whole = 0;
    boxes.parts.clear();
    const std::uint32_t cell_x = cell % side_, cell_y = cell / side_;
    const auto corner_x = static_cast<std::uint32_t>(cell_x * width_),
               corner_y = static_cast<std::uint32_t>(cell_y * width_);
    const std::vector<Column> xs = columns(cell_x, left, length), ys = columns(cell_y, left, length);
    for (const Column& row : ys)
        for (const Column& column : xs) {
            const std::size_t from = std::size_t{row.index} * side_ + column.index;
            if (row.whole && column.whole) {
                boxes.whole += starts_[from + 1] - starts_[from];
                if (stop_at_whole && boxes.whole > 0) return;
                continue;
            }
            for (std::uint32_t i = starts_[from]; i < starts_[from + 1]; ++i) {
                const FixedPoint2& p = points_[i];
                const auto start = static_cast<std::uint32_t>(left);
                const Pieces x(p.x - start - corner_x, length, width_), y(p.y - start - corner_y, length, width_);
                if (x.covers(width_) && y.covers(width_)) {
                    ++boxes.whole;
                    if (stop_at_whole) return;
                    continue;
                }
                for (unsigned a = 0; a < x.count; ++a)
                    for (unsigned b = 0; b < y.count; ++b)
                        boxes.parts.push_back({x.from[a], x.to[a], y.from[b], y.to[b]});
            }
        }
}

}  // namespace raycache::tracer
