// random: an independent uniform number per pixel, sample index and dimension; the sequence is not used. The worst case
// for a cache, and plain Monte Carlo.
#include "tracer/sampling/decorrelation.hpp"
#include "tracer/sampling/hash.hpp"

namespace raycache::tracer {

namespace {

class Random final : public Decorrelation {
public:
    explicit Random(std::uint64_t seed) : key_(seed, HashPurpose::independent) {}

    std::uint32_t apply(std::uint32_t, std::uint32_t pixel, std::uint32_t index,
                        std::uint32_t dimension) const override {
        return key_.words(pixel, dimension, index)[0];
    }

private:
    HashKey key_;
};

}  // namespace

DecorrelationEntry random_entry() {
    return {.name = "random",
            .description = "an independent random number per pixel, sample and dimension; ignores the sequence",
            .make = [](const Parameters&, const SampleSet& samples, const Sequence&) -> std::unique_ptr<Decorrelation> {
                return std::make_unique<Random>(samples.seed);
            },
            .reads_sequence = false,
            .independent_pixels = true};
}

}  // namespace raycache::tracer
