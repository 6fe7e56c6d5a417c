// micro-jitter: y = frac(x_i + mu * xi_{p,d}), xi uniform in [-1/2, 1/2), one per pixel and dimension, the same for all
// samples; mu = min(1, K * N^(-1/s)). A. Dufay, P. Lecocq, R. Pacanowski, J.-E. Marvie, X. Granier, "Cache-friendly
// micro-jittered sampling", SIGGRAPH 2016 Talks, eq. 1 and 2. K is a number or (N * D*_N)^(1/s), a reading of the
// paper's "constant representative of the star discrepancy"; s the dimensions sampled jointly: 2 for the decisions of a
// path one by one, or any other number, or all of them.
//
// xi is that of cranley-patterson for the same seed: at mu = 1 the two differ by a shift of 1/2 (2^31).
#include <fmt/format.h>

#include "tracer/sampling/decorrelation.hpp"
#include "tracer/sampling/fixed_mu.hpp"
#include "tracer/sampling/hash.hpp"

namespace raycache::tracer {

namespace {

class MicroJitter final : public Decorrelation {
public:
    MicroJitter(const DecorrelationSettings& settings, const SampleSet& samples)
        : settings_(settings),
          spp_(samples.spp),
          key_(samples.seed, HashPurpose::pixel_offset),
          mu_(effective_mu(settings, spp_)) {}

    std::uint32_t apply(std::uint32_t x, std::uint32_t pixel, std::uint32_t, std::uint32_t dimension) const override {
        return x + mu_.symmetric(pixel_offset(key_, pixel, dimension));  // wraps: modulo 1 in fixed point
    }

    std::string parameters() const override {
        const double mu = effective_mu(settings_, spp_);
        if (settings_.mu) return fmt::format("mu={}", mu);
        const std::string k = settings_.k_from_discrepancy ? fmt::format("discrepancy({:.6g})", settings_.k)
                                                           : fmt::format("{}", settings_.k);
        const std::string s = settings_.full_s ? fmt::format("full({})", settings_.s) : fmt::format("{}", settings_.s);
        return fmt::format("K={} s={} mu={:.6g}", k, s, mu);
    }

    std::string warning() const override {
        const double requested = requested_mu(settings_, spp_);
        if (requested <= 1.0) return {};
        return fmt::format("mu {:.6g} clamped to 1: micro-jitter is then a Cranley-Patterson rotation", requested);
    }

private:
    DecorrelationSettings settings_;
    std::uint64_t spp_;
    HashKey key_;
    FixedMu mu_;
};

}  // namespace

DecorrelationEntry micro_jitter_entry() {
    return {"micro-jitter", "a random offset from a window of width mu per pixel and dimension, modulo 1: the paper",
            [](const DecorrelationSettings& settings, const SampleSet& samples,
               const Sequence& sequence) -> std::unique_ptr<Decorrelation> {
                return std::make_unique<MicroJitter>(
                    settings.mu ? settings : resolve_k_and_s(settings, samples, sequence), samples);
            },
            [](const DecorrelationSettings& settings) -> std::vector<Parameter> {
                if (settings.mu) return {Parameter::sequence, Parameter::seed, Parameter::mu};
                return {Parameter::sequence, Parameter::seed, Parameter::k, Parameter::s};
            }};
}

}  // namespace raycache::tracer
