// interleaved: pixels fall into m x m classes (px mod m, py mod m); pixels of one class share their points, different
// classes have different ones. A. Keller, W. Heidrich, "Interleaved sampling", EGWR 2001. The points of a class are the
// base points rotated by a random offset of its own: y = frac(x_i + xi_{class,d}), which any sequence allows. The
// thread map `classes` gathers warps from pixels of one class.
#include <fmt/format.h>

#include "tracer/sampling/decorrelation.hpp"
#include "tracer/sampling/hash.hpp"
#include "tracer/sampling/pixel_place.hpp"

namespace raycache::tracer {

namespace {

class Interleaved final : public Decorrelation {
public:
    Interleaved(const Parameters& parameters, const SampleSet& samples)
        : key_(samples.seed, HashPurpose::class_offset),
          places_("interleaved", samples.width),
          m_(interleave_of(parameters)) {}

    std::uint32_t apply(std::uint32_t x, std::uint32_t pixel, std::uint32_t, std::uint32_t dimension) const override {
        return x + pixel_offset(key_, places_.class_of(pixel, m_), dimension);  // wraps: modulo 1 in fixed point
    }
    std::string parameters() const override { return fmt::format("m={}", m_); }

private:
    HashKey key_;
    PixelPlaces places_;
    std::uint32_t m_;
};

}  // namespace

DecorrelationEntry interleaved_entry() {
    return {.name = "interleaved",
            .description = "m x m pixel classes, each with an offset of its own, the same points inside a class",
            .make = [](const Parameters& parameters, const SampleSet& samples, const Sequence&)
                -> std::unique_ptr<Decorrelation> { return std::make_unique<Interleaved>(parameters, samples); },
            .parameters = {interleave_parameter},
            .has_classes = true};
}

}  // namespace raycache::tracer
