// How one sequence is made different from pixel to pixel. One file per decorrelation in decorrelations/, one line each
// in decorrelations/registry.cpp. Arithmetic is modulo 2^32 in fixed point; see docs/sampling.md.
// Every decorrelation is a pure function of its arguments and settings: const, no state, safe from any thread.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tracer/sampling/cycles_distance.hpp"
#include "tracer/sampling/sample_set.hpp"
#include "tracer/sampling/sequence.hpp"

namespace raycache::tracer {

/// What the user may set. Fields that a decorrelation does not use are ignored by it.
struct DecorrelationSettings {
    double k = 2.5;                   ///< K of mu = min(1, K * N^(-1/s))
    bool k_from_discrepancy = false;  ///< K = (N * D*_N)^(1/s) instead, D*_N of dimensions 0 and 1 of the sequence
    unsigned s = 2;                   ///< dimension in the same formula
    bool full_s = false;              ///< s = `dimensions` instead
    std::optional<double> mu;         ///< given directly, 0 … 1; overrides K and s
    CyclesSettings cycles;            ///< what scrambling-distance makes its mu of, unless `mu` is given
    unsigned interleave = 8;          ///< m of m x m pixel classes, 1 … max_interleave
};

inline constexpr unsigned max_interleave = 256;

/// What a user may set, as typed: to_string() is the name of the option. The sequence counts as one.
enum class Parameter {
    sequence,
    seed,
    k,
    s,
    mu,
    interleave,
    cycles_multiplier,
    cycles_min_samples,
    cycles_noise_threshold
};
/// "k", "cycles-min-samples", …
const char* to_string(Parameter);

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
    /// For that sequence, which need not outlive the call. Throws UsageError where the two together are not defined.
    std::unique_ptr<Decorrelation> (*make)(const DecorrelationSettings&, const SampleSet&, const Sequence&);
    /// Which parameters change a value under those settings; all others may be anything.
    std::vector<Parameter> (*reads)(const DecorrelationSettings&);
    bool has_classes = false;  ///< pixels of one class (px mod m, py mod m) share what others do not
    /// A pixel's values are uniform and independent of other pixels' for every sequence, given its points: pictures
    /// have no bias and neighbours no shared error.
    bool independent_pixels = false;

    bool reads_parameter(Parameter, const DecorrelationSettings&) const;
};
const std::vector<DecorrelationEntry>& decorrelations();

/// Throws UsageError for K or mu negative or not finite, s = 0, an `interleave` out of range and
/// as check_cycles() does: for every decorrelation, even one that ignores the field. mu above 1 is not an error.
void check_settings(const DecorrelationSettings&);

/// mu of micro-jitter as the settings ask for it, before the clamp: `mu` if given, else K * N^(-1/s) (eq. 2 of the
/// paper). Precondition: check_settings() passes; K and s are numbers (resolve_k_and_s).
double requested_mu(const DecorrelationSettings&, std::uint64_t spp);

/// mu of scrambling-distance before the clamp: `mu` if given, else cycles_distance().
double scrambling_distance(const DecorrelationSettings&, std::uint64_t spp);

/// min(1, requested_mu): above 1 the wrapped jitter would cover part of the unit interval twice.
double effective_mu(const DecorrelationSettings&, std::uint64_t spp);

/// The settings with `full_s` and `k_from_discrepancy` worked out into s and k. Throws UsageError where the path's
/// dimensions are not known, or N is too large for the exact discrepancy.
DecorrelationSettings resolve_k_and_s(const DecorrelationSettings&, const SampleSet&, const Sequence&);

/// Throws UsageError unless every aligned group of s dimensions of the sequence is a net in base 2.
void require_net(const std::string& decorrelation, const Sequence&, unsigned s);
/// log2(N). Throws UsageError unless N is a power of two.
unsigned require_power_of_two(const std::string& decorrelation, std::uint64_t spp);

/// Throws UsageError for an unknown name (listing the valid ones) and as check_spp() and check_settings() do. mu above
/// 1 is clamped to 1; Decorrelation::warning() says so. Without a sequence: for the default one, sobol.
std::unique_ptr<Decorrelation> make_decorrelation(const std::string& name, const DecorrelationSettings&,
                                                  const SampleSet&, const Sequence&);
std::unique_ptr<Decorrelation> make_decorrelation(const std::string& name, const DecorrelationSettings&,
                                                  const SampleSet&);

/// The entry of that name. Throws UsageError that lists the valid names.
const DecorrelationEntry& find_decorrelation(const std::string& name);

}  // namespace raycache::tracer
