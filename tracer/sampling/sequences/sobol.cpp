// sobol: the Sobol sequence with the direction numbers of S. Joe and F. Y. Kuo (2008), file new-joe-kuo-6, 1024
// dimensions, first dimensions native: dimension 0 is the van der Corput sequence in base 2.
//
// Natural order: point i is the XOR of the direction numbers V_k of the bits k set in i, so that any point costs at
// most 32 operations and needs no state. (SciPy and most generators use Gray-code order, a permutation of each block of
// 2^m points.) Recurrence for a primitive polynomial x^s + a_1 x^(s-1) + … + a_(s-1) x + 1, V_k = m_k * 2^(32-k):
//     V_k = a_1 V_(k-1) ^ … ^ a_(s-1) V_(k-s+1) ^ V_(k-s) ^ (V_(k-s) >> s)
// P. Bratley, B. L. Fox, "Algorithm 659", ACM TOMS 14(1), 1988.
#include <array>
#include <bit>

#include "tracer/sampling/sequence.hpp"

namespace raycache::tracer {

namespace {

constexpr std::uint32_t table_dimensions = 1024;
constexpr unsigned bits = 32;
constexpr unsigned max_degree = 13;

struct TableRow {
    std::uint32_t polynomial;  ///< bit k = coefficient of x^k
    std::array<std::uint16_t, max_degree> initial;
};

constexpr TableRow table[] = {
#include "tracer/sampling/sequences/joe_kuo_6.inc"
};
static_assert(std::size(table) == table_dimensions - 1, "dimension 0 has no row");

using DirectionNumbers = std::array<std::uint32_t, bits>;

DirectionNumbers van_der_corput() {
    DirectionNumbers v{};
    for (unsigned k = 0; k < bits; ++k) v[k] = std::uint32_t{1} << (bits - 1 - k);
    return v;
}

DirectionNumbers directions(const TableRow& row) {
    const auto degree = static_cast<unsigned>(std::bit_width(row.polynomial)) - 1;
    DirectionNumbers v{};
    for (unsigned k = 0; k < degree; ++k) v[k] = std::uint32_t{row.initial[k]} << (bits - 1 - k);
    for (unsigned k = degree; k < bits; ++k) {
        v[k] = v[k - degree] ^ (v[k - degree] >> degree);
        for (unsigned j = 1; j < degree; ++j) {
            if ((row.polynomial >> (degree - j)) & 1U) v[k] ^= v[k - j];
        }
    }
    return v;
}

class Sobol final : public Sequence {
public:
    Sobol() {
        directions_.reserve(table_dimensions);
        directions_.push_back(van_der_corput());
        for (const TableRow& row : table) directions_.push_back(directions(row));
    }

    std::uint32_t sample(std::uint32_t index, std::uint32_t dimension) const override {
        const DirectionNumbers& v = directions_[dimension];
        std::uint32_t x = 0;
        for (; index != 0; index &= index - 1) x ^= v[static_cast<unsigned>(std::countr_zero(index))];
        return x;
    }

    std::uint32_t dimensions() const override { return table_dimensions; }

private:
    std::vector<DirectionNumbers> directions_;
};

}  // namespace

SequenceEntry sobol_entry() {
    return {"sobol", "Sobol sequence, Joe-Kuo direction numbers (new-joe-kuo-6), 1024 dimensions",
            []() -> std::unique_ptr<Sequence> { return std::make_unique<Sobol>(); }};
}

}  // namespace raycache::tracer
