#include "tracer/sampling/digital_net.hpp"

namespace raycache::tracer {
namespace {

/// Vectors over GF(2), bit per component, each reduced by those before it.
class Basis {
public:
    /// False where `row` depends on the rows added before.
    bool add(std::uint32_t row) {
        while (row != 0) {
            std::uint32_t& pivot = by_top_bit_[static_cast<unsigned>(std::bit_width(row)) - 1];
            if (pivot == 0) {
                pivot = row;
                return true;
            }
            row ^= pivot;
        }
        return false;
    }

private:
    std::array<std::uint32_t, 32> by_top_bit_{};
};

/// Row `digit` of the generator matrix, cut to m columns.
std::uint32_t row_of(const DirectionNumbers& v, unsigned digit, unsigned m) {
    std::uint32_t row = 0;
    for (unsigned column = 0; column < m; ++column) row |= ((v[column] >> (31 - digit)) & 1U) << column;
    return row;
}

}  // namespace

bool equal_cells(std::span<const DirectionNumbers> dimensions, std::span<const unsigned> bits, unsigned m) {
    Basis basis;
    for (std::size_t d = 0; d < dimensions.size(); ++d)
        for (unsigned digit = 0; digit < bits[d]; ++digit)
            if (digit >= 32 || !basis.add(row_of(dimensions[d], digit, m))) return false;
    return true;
}

}  // namespace raycache::tracer
