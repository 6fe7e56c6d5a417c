// cranley-patterson: y = frac(x_i + xi_{p,d}), xi uniform in [0, 1), one per pixel and dimension.
// R. Cranley, T. N. L. Patterson, "Randomization of Number Theoretic Methods for Multiple Integration", SIAM J. Numer.
// Anal. 13(6), 1976; per pixel in rendering: T. Kollig, A. Keller, "Efficient Multidimensional Sampling", CGF 21(3),
// 2002.
#include "tracer/sampling/decorrelation.hpp"
#include "tracer/sampling/hash.hpp"

namespace raycache::tracer {

namespace {

class CranleyPatterson final : public Decorrelation {
public:
    explicit CranleyPatterson(std::uint64_t seed) : key_(seed, HashPurpose::pixel_offset) {}

    std::uint32_t apply(std::uint32_t x, std::uint32_t pixel, std::uint32_t, std::uint32_t dimension) const override {
        return x + pixel_offset(key_, pixel, dimension);  // wraps: modulo 1 in fixed point
    }

private:
    HashKey key_;
};

}  // namespace

DecorrelationEntry cranley_patterson_entry() {
    return {.name = "cranley-patterson",
            .description = "a random offset in [0, 1) per pixel and dimension, modulo 1",
            .make = [](const Parameters&, const SampleSet& samples, const Sequence&) -> std::unique_ptr<Decorrelation> {
                return std::make_unique<CranleyPatterson>(samples.seed);
            },
            .independent_pixels = true};
}

}  // namespace raycache::tracer
