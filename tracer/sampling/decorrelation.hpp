// How one sequence is made different from pixel to pixel. One file per decorrelation in decorrelations/, one line each
// in decorrelations/registry.cpp. Arithmetic is modulo 2^32 in fixed point; see docs/sampling.md.
// Every decorrelation is a pure function of its arguments and settings: const, no state, safe from any thread.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace raycache::tracer {

/// What the user may set. Fields that a decorrelation does not use are ignored by it.
struct DecorrelationSettings {
    std::uint64_t spp = 1;  ///< N, the size of the sample set, 1 … 2^32
    std::uint64_t seed = 0;
    double k = 2.5;            ///< K of mu = min(1, K * N^(-1/s))
    unsigned s = 2;            ///< dimension in the same formula
    std::optional<double> mu;  ///< given directly, 0 … 1; overrides K and s
    bool cycles_mu = false;    ///< `--mu cycles`: mu = min(1, 4/sqrt(N)), one-sided offset in [0, mu)
};

class Decorrelation {
public:
    virtual ~Decorrelation() = default;
    /// Value for one pixel from x = coordinate `dimension` of point `index` of the base sequence.
    virtual std::uint32_t apply(std::uint32_t x, std::uint32_t pixel, std::uint32_t index,
                                std::uint32_t dimension) const = 0;
    /// The effective parameters in words, such as "K=2.5 s=2 mu=0.078125"; empty if there are none.
    virtual std::string parameters() const { return {}; }
    /// One line for the user when a setting was adjusted, such as "mu 1.58 clamped to 1 …"; empty if none was.
    virtual std::string warning() const { return {}; }
};

struct DecorrelationEntry {
    std::string name, description;
    std::unique_ptr<Decorrelation> (*make)(const DecorrelationSettings&);
};
const std::vector<DecorrelationEntry>& decorrelations();

/// Throws UsageError unless N is 1 … 2^32.
void check_spp(std::uint64_t spp);

/// Throws UsageError for N = 0 or above 2^32, K or mu negative or not finite, s = 0, and mu given both as a number and
/// as cycles_mu: for every decorrelation, even one that ignores the field. mu above 1 is not an error.
void check_settings(const DecorrelationSettings&);

/// mu as the settings ask for it, before the clamp: `mu` if given, else 4/sqrt(N) for cycles_mu, else K * N^(-1/s)
/// (eq. 2 of the paper). Precondition: check_settings() passes.
double requested_mu(const DecorrelationSettings&);

/// min(1, requested_mu): above 1 the wrapped jitter would cover part of the unit interval twice.
double effective_mu(const DecorrelationSettings&);

/// Throws UsageError for an unknown name (listing the valid ones) and as check_settings() does. mu above 1 is clamped
/// to 1; Decorrelation::warning() says so.
std::unique_ptr<Decorrelation> make_decorrelation(const std::string& name, const DecorrelationSettings&);

}  // namespace raycache::tracer
