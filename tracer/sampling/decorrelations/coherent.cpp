// coherent: y = x_i for every pixel. I. Sadeghi, B. Chen, H. W. Jensen, "Coherent Path Tracing", Journal of Graphics,
// GPU, and Game Tools 14(2), 2009. The best case for a cache; the error of all pixels is the same, so it is structured.
#include "tracer/sampling/decorrelation.hpp"

namespace raycache::tracer {

namespace {

class Coherent final : public Decorrelation {
public:
    std::uint32_t apply(std::uint32_t x, std::uint32_t, std::uint32_t, std::uint32_t) const override { return x; }
};

}  // namespace

DecorrelationEntry coherent_entry() {
    return {.name = "coherent",
            .description = "the same points for every pixel",
            .make = [](const Parameters&, const SampleSet&, const Sequence&) -> std::unique_ptr<Decorrelation> {
                return std::make_unique<Coherent>();
            },
            .reads_seed = false};
}

}  // namespace raycache::tracer
