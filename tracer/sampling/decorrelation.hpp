// How one sequence is made different from pixel to pixel. One file per decorrelation in decorrelations/, one line each
// in decorrelations/registry.cpp. Arithmetic is modulo 2^32 in fixed point; see docs/sampling.md.
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
};

struct DecorrelationEntry {
    std::string name, description;
    std::unique_ptr<Decorrelation> (*make)(const DecorrelationSettings&);
};
const std::vector<DecorrelationEntry>& decorrelations();

/// Throws UsageError for an unknown name (listing the valid ones), N = 0 or above 2^32, K or mu negative or not a
/// number, s = 0. mu above 1 is clamped to 1.
std::unique_ptr<Decorrelation> make_decorrelation(const std::string& name, const DecorrelationSettings&);

}  // namespace raycache::tracer
