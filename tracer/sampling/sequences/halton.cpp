// halton: dimension d is the radical inverse in the d-th prime base (2, 3, 5, …, 8161), not scrambled, 1024 dimensions.
// J. H. Halton, "On the efficiency of certain quasi-random sequences of points in evaluating multi-dimensional
// integrals", Numerische Mathematik 2, 1960.
//
// Exact: with k digits, the digits of i reversed are an integer r < base^k, and the result is floor(r * 2^32 / base^k).
// High dimensions are poor for few points: the first `base` points are i / base, a plain ramp.
#include "tracer/sampling/sequence.hpp"
#include "tracer/sampling/sequences/primes.hpp"

namespace raycache::tracer {

namespace {

constexpr std::uint32_t halton_dimensions = 1024;

__extension__ using Wide = unsigned __int128;  // r * 2^32 needs up to 77 bits

class Halton final : public Sequence {
public:
    Halton() : bases_(first_primes(halton_dimensions)) {}

    std::uint32_t sample(std::uint32_t index, std::uint32_t dimension) const override {
        const std::uint64_t base = bases_[dimension];
        std::uint64_t reversed = 0;
        std::uint64_t scale = 1;  // base^k, at most index * base < 2^45
        for (std::uint64_t rest = index; rest != 0; rest /= base) {
            reversed = reversed * base + rest % base;
            scale *= base;
        }
        return static_cast<std::uint32_t>((Wide{reversed} << 32) / scale);
    }

    std::uint32_t dimensions() const override { return halton_dimensions; }

private:
    std::vector<std::uint32_t> bases_;
};

}  // namespace

SequenceEntry halton_entry() {
    return {"halton", "Halton sequence, radical inverses in the first 1024 primes, not scrambled",
            [](std::uint64_t) -> std::unique_ptr<Sequence> { return std::make_unique<Halton>(); }, false};
}

}  // namespace raycache::tracer
