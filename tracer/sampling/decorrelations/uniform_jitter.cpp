// uniform-jitter: y = (i' + xi_{p,d}) / N: a regular pattern of N strata per dimension, moved as a whole by one offset
// below a stratum's width, xi uniform in [0, 1). R. Ramamoorthi, J. Anderson, M. Meyer, D. Nowrouzezahrai, "A theory of
// Monte Carlo visibility sampling", ACM TOG 31(5), 2012. i' = floor(N * x_i) is the stratum of the base point: the
// first N = 2^m points of a net in base 2 have one in each, so i' is a permutation of 0 … N-1 in every dimension, and
// pairs of dimensions stay as well spread as those of the net. Elsewhere the definition has no meaning.
//
// The same as scrambling-distance with d = 1/N on points whose digits end after the m-th.
#include "tracer/sampling/decorrelation.hpp"
#include "tracer/sampling/hash.hpp"

namespace raycache::tracer {

namespace {

class UniformJitter final : public Decorrelation {
public:
    /// Precondition: N = 2^m.
    UniformJitter(std::uint64_t seed, unsigned m)
        : key_(seed, HashPurpose::pixel_offset), m_(m), stratum_(~((std::uint64_t{1} << (32 - m)) - 1)) {}

    std::uint32_t apply(std::uint32_t x, std::uint32_t pixel, std::uint32_t, std::uint32_t dimension) const override {
        const std::uint64_t offset = std::uint64_t{pixel_offset(key_, pixel, dimension)} >> m_;  // m may be 32
        return static_cast<std::uint32_t>((x & stratum_) | offset);
    }

private:
    HashKey key_;
    unsigned m_;
    std::uint64_t stratum_;  ///< the digits of the stratum, in the low 32 bits
};

}  // namespace

DecorrelationEntry uniform_jitter_entry() {
    return {.name = "uniform-jitter",
            .description = "N regular strata per dimension, moved as a whole per pixel (Ramamoorthi et al. 2012)",
            .make = [](const Parameters&, const SampleSet& samples,
                       const Sequence& sequence) -> std::unique_ptr<Decorrelation> {
                require_net("uniform-jitter", sequence, 1);
                return std::make_unique<UniformJitter>(samples.seed,
                                                       require_power_of_two("uniform-jitter", samples.spp));
            }};
}

}  // namespace raycache::tracer
