// scrambling-distance: y = frac(x_i + d * xi_{p,d}), xi uniform in [0, 1), one per pixel and dimension:
// Cranley-Patterson rotation by a share d of its offset, as Blender Cycles has it since version 3.0 (release notes,
// "Scrambling Distance"). Automatic: d = min(1, 4 / sqrt(N)); otherwise the user's mu.
//
// xi is that of cranley-patterson for the same seed, so d = 1 is that decorrelation exactly, and d = 0 is coherent.
#include <fmt/format.h>

#include "tracer/sampling/decorrelation.hpp"
#include "tracer/sampling/fixed_mu.hpp"
#include "tracer/sampling/hash.hpp"

namespace raycache::tracer {

namespace {

class ScramblingDistance final : public Decorrelation {
public:
    /// Precondition: the distance is given, as mu or cycles_mu.
    explicit ScramblingDistance(const DecorrelationSettings& settings)
        : settings_(settings), key_(settings.seed, HashPurpose::pixel_offset), distance_(effective_mu(settings)) {}

    std::uint32_t apply(std::uint32_t x, std::uint32_t pixel, std::uint32_t, std::uint32_t dimension) const override {
        return x + distance_.one_sided(pixel_offset(key_, pixel, dimension));  // wraps: modulo 1 in fixed point
    }
    std::string parameters() const override {
        const double mu = effective_mu(settings_);
        return settings_.mu ? fmt::format("mu={}", mu) : fmt::format("mu=cycles({:.6g})", mu);
    }
    std::string warning() const override {
        const double requested = requested_mu(settings_);
        if (requested <= 1.0) return {};
        return fmt::format("mu {:.6g} clamped to 1: that is a Cranley-Patterson rotation", requested);
    }

private:
    DecorrelationSettings settings_;
    HashKey key_;
    FixedMu distance_;
};

}  // namespace

DecorrelationEntry scrambling_distance_entry() {
    return {"scrambling-distance",
            "a random offset in [0, d) per pixel and dimension, modulo 1; d = --mu or 4/sqrt(N): Cycles",
            [](const DecorrelationSettings& settings, const Sequence&) -> std::unique_ptr<Decorrelation> {
                DecorrelationSettings own = settings;
                own.cycles_mu = !settings.mu;
                return std::make_unique<ScramblingDistance>(own);
            }};
}

}  // namespace raycache::tracer
