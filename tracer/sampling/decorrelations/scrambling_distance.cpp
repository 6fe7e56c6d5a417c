// scrambling-distance: y = frac(x_i + d * xi_{p,d}), xi uniform in [0, 1), one per pixel and dimension:
// Cranley-Patterson rotation by a share d of its offset, as Blender Cycles has it for its pattern Tabulated Sobol. d is
// the automatic distance (cycles_distance.hpp) or the user's mu. From d = 1 on Cycles turns it off and gives each pixel
// a shuffled, Owen-like pattern (decorrelation owen); here d = 1 stays a rotation.
//
// xi is that of cranley-patterson for the same seed, so d = 1 is that decorrelation exactly, and d = 0 is coherent.
#include <fmt/format.h>

#include <algorithm>

#include "tracer/sampling/cycles_distance.hpp"
#include "tracer/sampling/decorrelation.hpp"
#include "tracer/sampling/fixed_mu.hpp"
#include "tracer/sampling/hash.hpp"

namespace raycache::tracer {

namespace {

constexpr ParameterEntry distance_parameter{.name = "mu",
                                            .description = "the distance itself, instead of the automatic one",
                                            .fallback = "",
                                            .label = "mu",
                                            .remedy = "give mu such as 0.1"};
constexpr ParameterEntry multiplier_parameter{.name = "cycles-multiplier",
                                              .description = "Blender's Scrambling Distance Multiplier",
                                              .fallback = "1",
                                              .label = "the multiplier of the scrambling distance",
                                              .remedy = "give --cycles-multiplier 1, Blender's default"};
constexpr ParameterEntry min_samples_parameter{.name = "cycles-min-samples",
                                               .description = "Blender's Min Samples; 0: automatic",
                                               .fallback = "0",
                                               .label = "the minimum number of samples",
                                               .remedy = "give --cycles-min-samples 0, Blender's default",
                                               .whole = true};
constexpr ParameterEntry threshold_parameter{
    .name = "cycles-noise-threshold",
    .description = "Blender's Noise Threshold; 0: automatic; off: no adaptive sampling",
    .fallback = "0.01",
    .label = "the noise threshold",
    .remedy = "give --cycles-noise-threshold 0.01, Blender's default, or off",
    .most = 1,
    .word = "off"};

CyclesSettings cycles_of(const Parameters& parameters) {
    CyclesSettings c{parameters.real(multiplier_parameter), parameters.whole(min_samples_parameter), {}};
    if (!parameters.is_word(threshold_parameter)) c.noise_threshold = parameters.real(threshold_parameter);
    return c;
}

class ScramblingDistance final : public Decorrelation {
public:
    /// `automatic`: what the distance was made of; empty where it was given.
    ScramblingDistance(std::uint64_t seed, double requested, std::string automatic)
        : key_(seed, HashPurpose::pixel_offset),
          requested_(requested),
          distance_(std::min(1.0, requested)),
          automatic_(std::move(automatic)) {}

    std::uint32_t apply(std::uint32_t x, std::uint32_t pixel, std::uint32_t, std::uint32_t dimension) const override {
        return x + distance_.one_sided(pixel_offset(key_, pixel, dimension));  // wraps: modulo 1 in fixed point
    }
    std::optional<double> mu() const override { return std::min(1.0, requested_); }
    std::string parameters() const override {
        if (automatic_.empty()) return fmt::format("mu={}", *mu());
        return fmt::format("{} mu={:.6g}{}", automatic_, *mu(), requested_ >= 1 ? " (off)" : "");
    }
    std::string warning() const override {
        if (automatic_.empty() && requested_ > 1)
            return fmt::format("mu {:.6g} clamped to 1: that is a Cranley-Patterson rotation", requested_);
        if (automatic_.empty() || requested_ < 1) return {};
        return fmt::format(
            "automatic scrambling distance {:.6g}: from 1 on Blender turns it off and every pixel has a pattern of its "
            "own (--strategy owen); this is a Cranley-Patterson rotation",
            requested_);
    }

private:
    HashKey key_;
    double requested_;
    FixedMu distance_;
    std::string automatic_;
};

std::unique_ptr<Decorrelation> make_scrambling_distance(const Parameters& parameters, const SampleSet& samples,
                                                        const Sequence&) {
    if (parameters.has(distance_parameter.name))
        return std::make_unique<ScramblingDistance>(samples.seed, parameters.real(distance_parameter), "");
    const CyclesSettings cycles = cycles_of(parameters);
    return std::make_unique<ScramblingDistance>(
        samples.seed, cycles_distance(cycles, samples.spp),
        fmt::format("multiplier={:.6g} distance_samples={}", cycles.multiplier, cycles_samples(cycles, samples.spp)));
}

std::vector<std::string> reads_of(const Parameters& given) {
    if (given.has(distance_parameter.name)) return {distance_parameter.name};
    std::vector<std::string> all{multiplier_parameter.name};
    const CyclesSettings c = cycles_of(given);
    if (c.noise_threshold) all.emplace_back(min_samples_parameter.name);
    // Off has to be known; a threshold plays no part beside minimum samples.
    if (!c.noise_threshold || c.min_samples == 0) all.emplace_back(threshold_parameter.name);
    return all;
}

}  // namespace

DecorrelationEntry scrambling_distance_entry() {
    return {.name = "scrambling-distance",
            .description =
                "a random offset in [0, d) per pixel and dimension, d automatic or --mu: Blender with the pattern "
                "Tabulated Sobol (off in a default Blender, whose pattern is blue noise)",
            .make = make_scrambling_distance,
            .parameters = {distance_parameter, multiplier_parameter, min_samples_parameter, threshold_parameter},
            .reads = reads_of};
}

}  // namespace raycache::tracer
