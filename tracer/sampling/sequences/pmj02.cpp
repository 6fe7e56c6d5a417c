// pmj02: progressive multi-jittered (0,2) samples. P. Christensen, A. Kensler, C. Kilpatrick, "Progressive
// multi-jittered sample sequences", CGF 37(4), 2018. The first 2^m points put one point into each elementary interval
// of area 2^-m.
//
// From 4^k to 2*4^k points, each point gets a partner in the diagonally opposite quarter of its cell; from there to
// 4^(k+1), each gets another in one of the two quarters left, at random, and that one a partner opposite to it. Inside
// its quarter a point's digits are chosen one by one, free ones at random, others so that no elementary interval is
// taken twice. The choice never fails: an interval that is about to be split holds exactly two points of the final set,
// and the digits of x depend on those of y only down to the cell, and the other way round.
//
// A table of 2^16 points, made once; larger N are refused. Pair 0 of the dimensions is the table. Pair q > 0 takes
// points 2^j … 2^(j+1)-1 among themselves in a shuffled order, so that the first 2^m points are the same, and
// Owen-scrambles both coordinates. For an N that is no power of two the last block is used in part: its points are
// spread over the cells, but are no net.
#include <algorithm>
#include <bit>
#include <numeric>

#include "tracer/sampling/owen_scramble.hpp"
#include "tracer/sampling/sequence.hpp"

namespace raycache::tracer {

namespace {

constexpr unsigned table_bits = 16;

struct Point {
    std::uint32_t x = 0, y = 0;
};

/// The leading `bits` bits.
std::uint32_t leading(std::uint32_t value, unsigned bits) {
    return static_cast<std::uint32_t>(std::uint64_t{value} >> (32 - bits));
}

/// Which elementary intervals of area 2^-level hold a point: 2^a columns by 2^(level-a) rows, for every a.
class Occupancy {
public:
    explicit Occupancy(unsigned level) : level_(level), taken_((level + std::size_t{1}) << level) {}

    /// Columns and rows are the leading bits of a point's coordinates; more bits than needed are cut off.
    std::size_t slot(unsigned a, std::uint32_t column, std::uint32_t row) const {
        return (std::size_t{a} << level_) | (std::size_t{column} << (level_ - a)) | row;
    }
    bool taken(unsigned a, std::uint32_t column, std::uint32_t row) const { return taken_[slot(a, column, row)]; }
    void take(const Point& p) {
        for (unsigned a = 0; a <= level_; ++a) taken_[slot(a, leading(p.x, a), leading(p.y, level_ - a))] = true;
    }

private:
    unsigned level_;
    std::vector<bool> taken_;
};

class Generator {
public:
    explicit Generator(std::uint64_t seed) : key_(seed, HashPurpose::point_numbers) {
        points_.reserve(std::size_t{1} << table_bits);
        points_.push_back({random_bits(), random_bits()});
        for (unsigned level = 1; level <= table_bits; ++level) extend(level);
    }
    std::vector<Point> take() { return std::move(points_); }

private:
    std::uint32_t random_bits() { return key_.words(counter_++, 0, 0)[0]; }

    /// From 2^(level-1) to 2^level points.
    void extend(unsigned level) {
        const std::size_t old = points_.size();
        const unsigned bits = (level + 1) / 2;  // of a quarter of a cell
        Occupancy occupied(level);
        for (const Point& p : points_) occupied.take(p);
        for (std::size_t i = 0; i < old; ++i) {
            // Where to start from: the points of the first half of an even level have just been added.
            const bool second_half = level % 2 == 0 && i >= old / 2;
            const Point& from = points_[second_half ? i + old / 2 : i];
            std::uint32_t column = leading(from.x, bits) ^ 1U, row = leading(from.y, bits) ^ 1U;  // opposite
            if (level % 2 == 0 && !second_half) ((random_bits() >> 31) != 0 ? column : row) ^= 1U;
            points_.push_back(place(occupied, level, bits, column, row));
            occupied.take(points_.back());
        }
    }

    /// A point in the quarter (column, row) of 2^bits by 2^bits, in no interval that is taken.
    Point place(const Occupancy& occupied, unsigned level, unsigned bits, std::uint32_t column, std::uint32_t row) {
        std::uint32_t x = column, y = row;
        const std::uint32_t free_x = random_bits(), free_y = random_bits();
        for (unsigned a = bits + 1; a <= level; ++a) {
            const unsigned coarse = bits - (level - a);  // bits to cut off the other coordinate
            x = x << 1 | ((free_x >> (32 - a)) & 1U);
            if (occupied.taken(a, x, row >> coarse)) x ^= 1U;
            y = y << 1 | ((free_y >> (32 - a)) & 1U);
            if (occupied.taken(level - a, column >> coarse, y)) y ^= 1U;
        }
        const unsigned known = std::max(bits, level);
        const std::uint32_t rest = ~0U >> known;
        return {x << (32 - known) | (free_x & rest), y << (32 - known) | (free_y & rest)};
    }

    HashKey key_;
    std::uint32_t counter_ = 0;
    std::vector<Point> points_;
};

class Pmj02 final : public Sequence {
public:
    explicit Pmj02(std::uint64_t seed)
        : shuffle_(seed, HashPurpose::set_shuffle),
          scramble_(seed, HashPurpose::point_scramble),
          table_(Generator(seed).take()) {}

    std::uint32_t sample(std::uint32_t index, std::uint32_t dimension) const override {
        const std::uint32_t set = dimension / 2;
        if (set != 0 && index > 1) index = shuffled(index, set);
        const std::uint32_t value = dimension % 2 == 0 ? table_[index].x : table_[index].y;
        return set == 0 ? value : owen_scramble(value, scramble_.words(dimension, 0, 0));
    }
    std::uint32_t dimensions() const override { return 1024; }
    std::uint64_t points() const override { return table_.size(); }
    std::uint32_t net_dimensions() const override { return 2; }
    bool equal_cells(std::uint32_t, std::span<const unsigned> bits, unsigned m) const override {
        return std::accumulate(bits.begin(), bits.end(), 0U) <= m;
    }

private:
    /// Exchanges the points of a block 2^j … 2^(j+1)-1.
    std::uint32_t shuffled(std::uint32_t index, std::uint32_t set) const {
        const auto bits = static_cast<unsigned>(std::bit_width(index)) - 1;
        const std::uint32_t block = 1U << bits, top = 32 - bits;
        return block | shuffle_index((index ^ block) << top, shuffle_.words(set, bits, 0)) >> top;
    }

    HashKey shuffle_, scramble_;
    std::vector<Point> table_;
};

}  // namespace

SequenceEntry pmj02_entry() {
    return {"pmj02",
            "progressive multi-jittered (0,2) samples in padded pairs, N up to 65536 (Christensen et al. 2018)",
            [](std::uint64_t seed) -> std::unique_ptr<Sequence> { return std::make_unique<Pmj02>(seed); }};
}

}  // namespace raycache::tracer
