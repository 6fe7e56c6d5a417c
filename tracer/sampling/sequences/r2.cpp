// r2: the plane's additive recurrence with the plastic number p, the real root of p^3 = p + 1:
//     x_i = frac(1/2 + i / p),  y_i = frac(1/2 + i / p^2)
// M. Roberts, "The unreasonable effectiveness of quasirandom sequences", 2018,
// https://extremelearning.com.au/unreasonable-effectiveness-of-quasirandom-sequences/; Kronecker sequences in general:
// H. Niederreiter, "Random Number Generation and Quasi-Monte Carlo Methods", SIAM 1992.
//
// Only pairs of dimensions: the generalisation R_d needs d numbers that get ever closer to 1, and its pairs of
// dimensions are poor. Pair 0 is the sequence as it stands. Pair q > 0 takes the points in a shuffled order
// (shuffle_index) and from a random start: a block of consecutive points is the first block, shifted. So for N = 2^m
// every pair is as good as pair 0; for another N its points are those of a few blocks.
//
// The steps are 64-bit fixed point, so that point 2^32 - 1 is still right to 2^-32.
#include "tracer/sampling/owen_scramble.hpp"
#include "tracer/sampling/sequence.hpp"

namespace raycache::tracer {

namespace {

constexpr std::uint64_t steps[2] = {0xC13FA9A902A6328FU, 0x91E10DA5C79E7B1CU};  // 2^64 / p, 2^64 / p^2
constexpr std::uint64_t half = std::uint64_t{1} << 63;

class R2 final : public Sequence {
public:
    explicit R2(std::uint64_t seed)
        : shuffle_(seed, HashPurpose::set_shuffle), start_(seed, HashPurpose::point_scramble) {}

    std::uint32_t sample(std::uint32_t index, std::uint32_t dimension) const override {
        const std::uint32_t set = dimension / 2;
        std::uint64_t start = half;
        if (set != 0) {
            index = shuffle_index(index, shuffle_.words(set, 0, 0));
            start = std::uint64_t{start_.words(dimension, 0, 0)[0]} << 32;
        }
        return static_cast<std::uint32_t>((start + index * steps[dimension % 2]) >> 32);  // wraps: modulo 1
    }
    std::uint32_t dimensions() const override { return 1024; }

private:
    HashKey shuffle_, start_;
};

}  // namespace

SequenceEntry r2_entry() {
    return {"r2", "R2, the plastic number's Kronecker sequence, in padded pairs (Roberts 2018)",
            [](std::uint64_t seed) -> std::unique_ptr<Sequence> { return std::make_unique<R2>(seed); }};
}

}  // namespace raycache::tracer
