// net-micro-jitter: all pixels share the leading k bits of a net's points; the bits below are Owen-scrambled per pixel
// and dimension:
//     y = (x & M) | (owen(x) & ~M),  M = the leading k bits,  |y - x| < mu = 2^-k
// An extension of this project (docs/sampling.md). Both parts are nested scramblings, so every pixel keeps a full net.
// Every point is uniform in its cell of side mu, and all cells hold equally many points, so the mean over pixels is
// exact for any integrand of the dimensions of one set. No wrap. This is the safe variant: sets of 4 dimensions
// jointly, which holds the interaction of two decisions of a path, at the price of a large mu, about N^(-1/4).
#include "tracer/sampling/decorrelations/net_bits.hpp"
#include "tracer/sampling/hash.hpp"
#include "tracer/sampling/owen_scramble.hpp"

namespace raycache::tracer {

namespace {

class NetMicroJitter final : public Decorrelation {
public:
    NetMicroJitter(const SampleSet& samples, const Sequence& sequence)
        : bits_("net-micro-jitter", 4, samples, sequence), key_(samples.seed, HashPurpose::pixel_scramble) {}

    std::uint32_t apply(std::uint32_t x, std::uint32_t pixel, std::uint32_t, std::uint32_t dimension) const override {
        const std::uint32_t shared = bits_.mask(dimension);
        return (x & shared) | (owen_scramble(x, key_.words(pixel, dimension, 0)) & ~shared);
    }
    std::string parameters() const override { return bits_.parameters(); }

private:
    NetBits bits_;
    HashKey key_;
};

}  // namespace

DecorrelationEntry net_micro_jitter_entry() {
    return {.name = "net-micro-jitter",
            .description = "leading bits of a net shared, the rest Owen-scrambled per pixel; unbiased in sets of 4",
            .make = [](const Parameters&, const SampleSet& samples, const Sequence& sequence)
                -> std::unique_ptr<Decorrelation> { return std::make_unique<NetMicroJitter>(samples, sequence); }};
}

}  // namespace raycache::tracer
