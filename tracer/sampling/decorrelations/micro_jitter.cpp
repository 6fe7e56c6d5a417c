// micro-jitter: y = frac(x_i + mu * xi_{p,d}), xi uniform in [-1/2, 1/2), one per pixel and dimension, the same for all
// samples; mu = min(1, K * N^(-1/s)). A. Dufay, P. Lecocq, R. Pacanowski, J.-E. Marvie, X. Granier, "Cache-friendly
// micro-jittered sampling", SIGGRAPH 2016 Talks, eq. 1 and 2. K is a number or (N * D*_N)^(1/s), a reading of the
// paper's "constant representative of the star discrepancy"; s the dimensions sampled jointly: 2 for the decisions of a
// path one by one, or any other number, or all of them.
//
// xi is that of cranley-patterson for the same seed: at mu = 1 the two differ by a shift of 1/2 (2^31).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tracer/sampling/decorrelation.hpp"
#include "tracer/sampling/fixed_mu.hpp"
#include "tracer/sampling/hash.hpp"
#include "tracer/sampling/measures/star_discrepancy.hpp"
#include "traces/error.hpp"

namespace raycache::tracer {

namespace {

constexpr ParameterEntry k_parameter{
    .name = "k",
    .description = "K of mu = min(1, K * N^(-1/s)), or 'discrepancy': (N * D*_N)^(1/s)",
    .fallback = "2.5",
    .label = "K",
    .remedy = "give K such as 2.5",
    .word = "discrepancy"};
constexpr ParameterEntry s_parameter{.name = "s",
                                     .description = "s of the same formula, or 'full': all dimensions of a path",
                                     .fallback = "2",
                                     .label = "the dimension s of mu = K * N^(-1/s)",
                                     .remedy = "give s = 2, the default",
                                     .whole = true,
                                     .least = 1,
                                     .most = 4294967295.0,
                                     .word = "full"};
constexpr ParameterEntry mu_parameter{.name = "mu",
                                      .description = "mu itself, instead of K and s",
                                      .fallback = "",
                                      .label = "mu",
                                      .remedy = "give mu such as 0.1"};

struct Formula {
    double k;
    unsigned s;
};

/// K and s as numbers. Throws UsageError where the path's dimensions are not known, or N is too large for the exact
/// discrepancy.
Formula formula_of(const Parameters& parameters, const SampleSet& samples, const Sequence& sequence) {
    Formula f{};
    if (parameters.is_word(s_parameter)) {
        if (samples.dimensions == 0)
            throw UsageError(
                "sampling: s = full needs the number of dimensions of a path, found none: give s as a number");
        f.s = samples.dimensions;
    } else {
        f.s = static_cast<unsigned>(parameters.whole(s_parameter));
    }
    if (!parameters.is_word(k_parameter)) {
        f.k = parameters.real(k_parameter);
        return f;
    }
    if (samples.spp > max_star_discrepancy_points)
        throw UsageError(fmt::format(
            "sampling: K from the star discrepancy is computed exactly, for N up to {}, found N = {}: give K as a "
            "number such as 2.5",
            max_star_discrepancy_points, samples.spp));
    std::vector<FixedPoint2> points;
    for (std::uint32_t i = 0; i < samples.spp; ++i) points.push_back({sequence.sample(i, 0), sequence.sample(i, 1)});
    f.k = std::pow(static_cast<double>(samples.spp) * star_discrepancy(points), 1.0 / f.s);
    return f;
}

/// K * N^(-1/s), eq. 2 of the paper, before the clamp.
double mu_of(const Formula& f, std::uint64_t spp) {
    const auto n = static_cast<double>(spp);
    // The two common cases need no pow(), whose last digit depends on the C library and processor.
    if (f.s == 1) return f.k / n;
    if (f.s == 2) return f.k / std::sqrt(n);
    return f.k / std::pow(n, 1.0 / f.s);
}

class MicroJitter final : public Decorrelation {
public:
    MicroJitter(std::uint64_t seed, double requested, std::string formula)
        : key_(seed, HashPurpose::pixel_offset),
          requested_(requested),
          mu_(std::min(1.0, requested)),
          formula_(std::move(formula)) {}

    std::uint32_t apply(std::uint32_t x, std::uint32_t pixel, std::uint32_t, std::uint32_t dimension) const override {
        return x + mu_.symmetric(pixel_offset(key_, pixel, dimension));  // wraps: modulo 1 in fixed point
    }
    std::optional<double> mu() const override { return std::min(1.0, requested_); }
    std::string parameters() const override {
        return formula_.empty() ? fmt::format("mu={}", *mu()) : fmt::format("{} mu={:.6g}", formula_, *mu());
    }
    std::string warning() const override {
        if (requested_ <= 1.0) return {};
        return fmt::format("mu {:.6g} clamped to 1: micro-jitter is then a Cranley-Patterson rotation", requested_);
    }

private:
    HashKey key_;
    double requested_;  ///< before the clamp: above 1 the wrapped jitter would cover part of the interval twice
    FixedMu mu_;
    std::string formula_;  ///< "K=2.5 s=2"; empty where mu was given
};

std::unique_ptr<Decorrelation> make_micro_jitter(const Parameters& parameters, const SampleSet& samples,
                                                 const Sequence& sequence) {
    if (parameters.has(mu_parameter.name))
        return std::make_unique<MicroJitter>(samples.seed, parameters.real(mu_parameter), "");
    const Formula f = formula_of(parameters, samples, sequence);
    const std::string k =
        parameters.is_word(k_parameter) ? fmt::format("discrepancy({:.6g})", f.k) : fmt::format("{}", f.k);
    const std::string s = parameters.is_word(s_parameter) ? fmt::format("full({})", f.s) : fmt::format("{}", f.s);
    return std::make_unique<MicroJitter>(samples.seed, mu_of(f, samples.spp), fmt::format("K={} s={}", k, s));
}

}  // namespace

DecorrelationEntry micro_jitter_entry() {
    return {.name = "micro-jitter",
            .description = "a random offset from a window of width mu per pixel and dimension, modulo 1: the paper",
            .make = make_micro_jitter,
            .parameters = {mu_parameter, k_parameter, s_parameter},
            .reads = [](const Parameters& given) -> std::vector<std::string> {
                if (given.has(mu_parameter.name)) return {mu_parameter.name};
                return {k_parameter.name, s_parameter.name};
            }};
}

}  // namespace raycache::tracer
