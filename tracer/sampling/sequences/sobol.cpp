// sobol: the Sobol sequence with the direction numbers of S. Joe and F. Y. Kuo (2008), file new-joe-kuo-6, 1024
// dimensions, first dimensions native: dimension 0 is the van der Corput sequence in base 2.
//
// Natural order: point i is the XOR of the direction numbers V_k of the bits k set in i, so that any point costs at
// most 32 operations and needs no state. (SciPy and most generators use Gray-code order, a permutation of each block of
// 2^m points.)
#include "tracer/sampling/sequence.hpp"
#include "tracer/sampling/sequences/sobol_directions.hpp"

namespace raycache::tracer {

namespace {

class Sobol final : public Sequence {
public:
    std::uint32_t sample(std::uint32_t index, std::uint32_t dimension) const override {
        return digital_point(directions_[dimension], index);
    }
    std::uint32_t dimensions() const override { return static_cast<std::uint32_t>(directions_.size()); }
    std::uint32_t net_dimensions() const override { return dimensions(); }
    bool equal_cells(std::uint32_t first, std::span<const unsigned> bits, unsigned m) const override {
        return tracer::equal_cells(std::span(directions_).subspan(first, bits.size()), bits, m);
    }

private:
    const std::vector<DirectionNumbers>& directions_ = sobol_directions();
};

}  // namespace

SequenceEntry sobol_entry() {
    return {"sobol", "Sobol sequence, Joe-Kuo direction numbers (new-joe-kuo-6), 1024 dimensions",
            [](std::uint64_t) -> std::unique_ptr<Sequence> { return std::make_unique<Sobol>(); }, false};
}

}  // namespace raycache::tracer
