// net-micro-jitter-fast: net-micro-jitter with a mu as small as in two dimensions, about N^(-1/2), and m x m pixel
// classes (interleaved.cpp) whose nets differ:
//     y = (owen_class(x) & M) | (owen_pixel(x) & ~M),  M = the leading k bits
// k is chosen for pairs of dimensions. What pixels err together, in the interaction of pairs, differs from class to
// class and so averages out over m x m pixels. A scrambling of the leading bits depends on those bits only, so both
// parts together are one nested scrambling: every pixel keeps a full net. Use it with the thread map `classes`, which
// gathers warps from pixels of one class.
#include <fmt/format.h>

#include "tracer/sampling/decorrelations/net_bits.hpp"
#include "tracer/sampling/hash.hpp"
#include "tracer/sampling/owen_scramble.hpp"
#include "tracer/sampling/pixel_place.hpp"

namespace raycache::tracer {

namespace {

class FastNetMicroJitter final : public Decorrelation {
public:
    FastNetMicroJitter(const Parameters& parameters, const SampleSet& samples, const Sequence& sequence)
        : bits_("net-micro-jitter-fast", 2, samples, sequence),
          places_("net-micro-jitter-fast", samples.width),
          class_key_(samples.seed, HashPurpose::class_scramble),
          pixel_key_(samples.seed, HashPurpose::pixel_scramble),
          m_(interleave_of(parameters)) {}

    std::uint32_t apply(std::uint32_t x, std::uint32_t pixel, std::uint32_t, std::uint32_t dimension) const override {
        const std::uint32_t shared = bits_.mask(dimension);
        const HashWords of_class = class_key_.words(places_.class_of(pixel, m_), dimension, 0);
        return (owen_scramble(x, of_class) & shared) |
               (owen_scramble(x, pixel_key_.words(pixel, dimension, 0)) & ~shared);
    }
    std::string parameters() const override { return fmt::format("{} m={}", bits_.parameters(), m_); }

private:
    NetBits bits_;
    PixelPlaces places_;
    HashKey class_key_, pixel_key_;
    std::uint32_t m_;
};

}  // namespace

DecorrelationEntry net_micro_jitter_fast_entry() {
    return {.name = "net-micro-jitter-fast",
            .description = "the same in sets of 2, with a net of its own for each of m x m pixel classes",
            .make = [](const Parameters& parameters, const SampleSet& samples,
                       const Sequence& sequence) -> std::unique_ptr<Decorrelation> {
                return std::make_unique<FastNetMicroJitter>(parameters, samples, sequence);
            },
            .parameters = {interleave_parameter},
            .has_classes = true};
}

}  // namespace raycache::tracer
