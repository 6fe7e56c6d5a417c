// owen: y = nested uniform scrambling of x_i, drawn anew for each pixel and dimension (owen_scramble.hpp). A. B. Owen,
// 1995; hash-based: S. Laine, T. Karras, CGF 30(4), 2011; B. Burley, JCGT 9(4), 2020. Each pixel keeps a full net of
// its own. For nets in base 2: in another base the swaps would tear the strata of the sequence apart.
#include "tracer/sampling/owen_scramble.hpp"

#include "tracer/sampling/decorrelation.hpp"
#include "tracer/sampling/hash.hpp"

namespace raycache::tracer {

namespace {

class Owen final : public Decorrelation {
public:
    explicit Owen(std::uint64_t seed) : key_(seed, HashPurpose::pixel_scramble) {}

    std::uint32_t apply(std::uint32_t x, std::uint32_t pixel, std::uint32_t, std::uint32_t dimension) const override {
        return owen_scramble(x, key_.words(pixel, dimension, 0));
    }

private:
    HashKey key_;
};

}  // namespace

DecorrelationEntry owen_entry() {
    return {
        .name = "owen",
        .description = "nested uniform scrambling per pixel and dimension (Owen 1995, hash-based); nets in base 2 only",
        .make = [](const Parameters&, const SampleSet& samples,
                   const Sequence& sequence) -> std::unique_ptr<Decorrelation> {
            require_net("owen", sequence, 1);
            return std::make_unique<Owen>(samples.seed);
        },
        .independent_pixels = true};
}

}  // namespace raycache::tracer
