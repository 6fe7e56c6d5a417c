// scrambling-distance: y = frac(x_i + d * xi_{p,d}), xi uniform in [0, 1), one per pixel and dimension:
// Cranley-Patterson rotation by a share d of its offset, as Blender Cycles has it for its pattern Tabulated Sobol. d is
// the automatic distance (cycles_distance.hpp) or the user's mu. From d = 1 on Cycles turns it off and gives each pixel
// a shuffled, Owen-like pattern (decorrelation owen); here d = 1 stays a rotation.
//
// xi is that of cranley-patterson for the same seed, so d = 1 is that decorrelation exactly, and d = 0 is coherent.
#include <fmt/format.h>

#include <algorithm>

#include "tracer/sampling/decorrelation.hpp"
#include "tracer/sampling/fixed_mu.hpp"
#include "tracer/sampling/hash.hpp"

namespace raycache::tracer {

namespace {

class ScramblingDistance final : public Decorrelation {
public:
    ScramblingDistance(const DecorrelationSettings& settings, const SampleSet& samples)
        : settings_(settings),
          spp_(samples.spp),
          key_(samples.seed, HashPurpose::pixel_offset),
          requested_(scrambling_distance(settings, spp_)),
          distance_(std::min(1.0, requested_)) {}

    std::uint32_t apply(std::uint32_t x, std::uint32_t pixel, std::uint32_t, std::uint32_t dimension) const override {
        return x + distance_.one_sided(pixel_offset(key_, pixel, dimension));  // wraps: modulo 1 in fixed point
    }
    std::string parameters() const override {
        if (settings_.mu) return fmt::format("mu={}", std::min(1.0, requested_));
        return fmt::format("multiplier={:.6g} distance_samples={} mu={:.6g}{}", settings_.cycles.multiplier,
                           cycles_samples(settings_.cycles, spp_), std::min(1.0, requested_),
                           requested_ >= 1 ? " (off)" : "");
    }
    std::string warning() const override {
        if (settings_.mu && requested_ > 1)
            return fmt::format("mu {:.6g} clamped to 1: that is a Cranley-Patterson rotation", requested_);
        if (settings_.mu || requested_ < 1) return {};
        return fmt::format(
            "automatic scrambling distance {:.6g}: from 1 on Blender turns it off and every pixel has a pattern of its "
            "own (--strategy owen); this is a Cranley-Patterson rotation",
            requested_);
    }

private:
    DecorrelationSettings settings_;
    std::uint64_t spp_;
    HashKey key_;
    double requested_;
    FixedMu distance_;
};

}  // namespace

DecorrelationEntry scrambling_distance_entry() {
    return {
        "scrambling-distance",
        "a random offset in [0, d) per pixel and dimension, d automatic or --mu: Blender with the pattern Tabulated "
        "Sobol (off in a default Blender, whose pattern is blue noise)",
        [](const DecorrelationSettings& settings, const SampleSet& samples, const Sequence&)
            -> std::unique_ptr<Decorrelation> { return std::make_unique<ScramblingDistance>(settings, samples); },
        [](const DecorrelationSettings& settings) -> std::vector<Parameter> {
            std::vector<Parameter> all{Parameter::sequence, Parameter::seed};
            const CyclesSettings& c = settings.cycles;
            if (settings.mu) {
                all.push_back(Parameter::mu);
            } else {
                all.push_back(Parameter::cycles_multiplier);
                all.push_back(Parameter::cycles_noise_threshold);  // at least to know that it is not off
                if (c.noise_threshold) all.push_back(Parameter::cycles_min_samples);
                if (c.noise_threshold && c.min_samples != 0) std::erase(all, Parameter::cycles_noise_threshold);
            }
            return all;
        }};
}

}  // namespace raycache::tracer
