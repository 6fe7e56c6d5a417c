// halton-scrambled: the Halton sequence with a nested random permutation of its digits. A. B. Owen, "Randomly permuted
// (t,m,s)-nets and (t,s)-sequences", 1995, in base b, the d-th prime: digit j of the result is a permutation of digit j
// of i, drawn anew for every value of the digits before it. The permutations are a -> (g a + h) mod b with g in 1 … b-1
// and h in 0 … b-1 at random (J. Matoušek, "On the L2-discrepancy for anchored boxes", J. Complexity 14, 1998): pairs
// of different digits go to pairs of different digits uniformly, which is all that Owen's variance depends on.
//
// The leading zeros of i are digits too and are permuted like the others, until b^k >= 2^32, the resolution.
#include <cstdint>

#include "tracer/sampling/hash.hpp"
#include "tracer/sampling/sequence.hpp"
#include "tracer/sampling/sequences/primes.hpp"

namespace raycache::tracer {

namespace {

constexpr std::uint32_t scrambled_dimensions = 1024;

__extension__ using Wide = unsigned __int128;  // r * 2^32 needs up to 77 bits

/// Uniform in 0 … bound-1 but for a bias below bound / 2^32.
std::uint32_t below(std::uint32_t bound, std::uint32_t random) {
    return static_cast<std::uint32_t>((std::uint64_t{random} * bound) >> 32);
}

class ScrambledHalton final : public Sequence {
public:
    explicit ScrambledHalton(std::uint64_t seed)
        : bases_(first_primes(scrambled_dimensions)), key_(seed, HashPurpose::point_scramble) {}

    std::uint32_t sample(std::uint32_t index, std::uint32_t dimension) const override {
        const std::uint32_t base = bases_[dimension];
        std::uint64_t path = 0;       // digits before this one, as they are in i: the node of the tree
        std::uint64_t scrambled = 0;  // the same digits, permuted
        std::uint64_t scale = 1;      // base^level, below 2^45
        std::uint32_t rest = index;
        for (std::uint32_t level = 0; scale < std::uint64_t{1} << 32; ++level) {
            const std::uint32_t digit = rest % base;
            rest /= base;
            const HashWords random = key_.words(dimension, level, static_cast<std::uint32_t>(path));
            const std::uint64_t permuted =
                (std::uint64_t{1 + below(base - 1, random[0])} * digit + below(base, random[1])) % base;
            path = path * base + digit;  // below 2^32 wherever it is used
            scrambled = scrambled * base + permuted;
            scale *= base;
        }
        return static_cast<std::uint32_t>((Wide{scrambled} << 32) / scale);
    }

    std::uint32_t dimensions() const override { return scrambled_dimensions; }

private:
    std::vector<std::uint32_t> bases_;
    HashKey key_;
};

}  // namespace

SequenceEntry halton_scrambled_entry() {
    return {"halton-scrambled", "Halton sequence with nested random permutations of the digits (Owen 1995)",
            [](std::uint64_t seed) -> std::unique_ptr<Sequence> { return std::make_unique<ScrambledHalton>(seed); }};
}

}  // namespace raycache::tracer
