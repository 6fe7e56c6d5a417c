// micro-jitter: y = frac(x_i + mu * xi_{p,d}), xi uniform in [-1/2, 1/2), one per pixel and dimension, the same for all
// samples; mu = min(1, K * N^(-1/s)). A. Dufay, P. Lecocq, R. Pacanowski, J.-E. Marvie, X. Granier, "Cache-friendly
// micro-jittered sampling", SIGGRAPH 2016 Talks, eq. 1 and 2. With cycles_mu: xi in [0, 1), mu = min(1, 4/sqrt(N)), the
// automatic scrambling distance of Blender Cycles 3.0.
//
// xi is that of cranley-patterson for the same seed: at mu = 1 the two differ by a shift of 1/2 (2^31), or not at all
// one-sided. mu is a multiple of 2^-32, so the jitter has no float rounding: a mu too small to move a float still moves
// y, and a mu that rounds to 0 gives x exactly.
#include <fmt/format.h>

#include "tracer/sampling/decorrelation.hpp"
#include "tracer/sampling/hash.hpp"

namespace raycache::tracer {

namespace {

class MicroJitter final : public Decorrelation {
public:
    explicit MicroJitter(const DecorrelationSettings& settings)
        : settings_(settings),
          key_(settings.seed, HashPurpose::pixel_offset),
          mu_(static_cast<std::int64_t>(effective_mu(settings) * 0x1p32 + 0.5)),
          one_sided_(settings.cycles_mu) {}

    std::uint32_t apply(std::uint32_t x, std::uint32_t pixel, std::uint32_t, std::uint32_t dimension) const override {
        const std::uint32_t xi = pixel_offset(key_, pixel, dimension);
        return x + (one_sided_ ? one_sided(xi) : symmetric(xi));  // wraps: modulo 1 in fixed point
    }

    std::string parameters() const override {
        const double mu = effective_mu(settings_);
        if (settings_.mu) return fmt::format("mu={}", mu);
        if (settings_.cycles_mu) return fmt::format("mu=cycles({:.6g})", mu);
        return fmt::format("K={} s={} mu={:.6g}", settings_.k, settings_.s, mu);
    }

    std::string warning() const override {
        const double requested = requested_mu(settings_);
        if (requested <= 1.0) return {};
        return fmt::format("mu {:.6g} clamped to 1: micro-jitter is then a Cranley-Patterson rotation", requested);
    }

private:
    /// floor(mu * xi), xi in [0, 1). The product is below 2^64.
    std::uint32_t one_sided(std::uint32_t xi) const {
        return static_cast<std::uint32_t>((std::uint64_t{xi} * static_cast<std::uint64_t>(mu_)) >> 32);
    }
    /// floor(mu * xi), xi in [-1/2, 1/2). The product is at least -2^63, which just fits.
    std::uint32_t symmetric(std::uint32_t xi) const {
        return static_cast<std::uint32_t>(((std::int64_t{xi} - (std::int64_t{1} << 31)) * mu_) >> 32);
    }

    DecorrelationSettings settings_;
    HashKey key_;
    std::int64_t mu_;  ///< mu * 2^32, 0 … 2^32
    bool one_sided_;
};

}  // namespace

DecorrelationEntry micro_jitter_entry() {
    return {"micro-jitter", "a random offset from a window of width mu per pixel and dimension, modulo 1: the paper",
            [](const DecorrelationSettings& settings) -> std::unique_ptr<Decorrelation> {
                return std::make_unique<MicroJitter>(settings);
            }};
}

}  // namespace raycache::tracer
