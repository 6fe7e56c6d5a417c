// Recurrence for a primitive polynomial x^s + a_1 x^(s-1) + … + a_(s-1) x + 1, V_k = m_k * 2^(32-k):
//     V_k = a_1 V_(k-1) ^ … ^ a_(s-1) V_(k-s+1) ^ V_(k-s) ^ (V_(k-s) >> s)
// P. Bratley, B. L. Fox, "Algorithm 659", ACM TOMS 14(1), 1988.
#include "tracer/sampling/sequences/sobol_directions.hpp"

#include <array>
#include <bit>
#include <iterator>

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

}  // namespace

const std::vector<DirectionNumbers>& sobol_directions() {
    static const std::vector<DirectionNumbers> all = [] {
        std::vector<DirectionNumbers> made;
        made.reserve(table_dimensions);
        made.push_back(van_der_corput());
        for (const TableRow& row : table) made.push_back(directions(row));
        return made;
    }();
    return all;
}

}  // namespace raycache::tracer
