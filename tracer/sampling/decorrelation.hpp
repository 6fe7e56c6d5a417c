// How one sequence is made different from pixel to pixel. One file per decorrelation in decorrelations/, one line each
// in decorrelations/registry.cpp. Arithmetic is modulo 2^32 in fixed point; see docs/sampling.md.
// Every decorrelation is a pure function of its arguments and settings: const, no state, safe from any thread.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tracer/sampling/parameters.hpp"
#include "tracer/sampling/sample_set.hpp"
#include "tracer/sampling/sequence.hpp"

namespace raycache::tracer {

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
    /// Width of the window that all values of a pixel are moved in, 0 … 1; nothing for those without such a width.
    virtual std::optional<double> mu() const { return {}; }
    /// The leading bits of that dimension that all pixels have in common, as a mask.
    virtual std::uint32_t shared_bits(std::uint32_t /*dimension*/) const { return 0; }
};

struct DecorrelationEntry {
    std::string name, description;
    /// For that sequence, which need not outlive the call. Throws UsageError for a parameter out of range and where the
    /// parts together are not defined.
    std::unique_ptr<Decorrelation> (*make)(const Parameters&, const SampleSet&, const Sequence&);
    /// What it may be given.
    std::vector<ParameterEntry> parameters = {};
    /// Which of them change a value beside those given; null: all. The others may be anything.
    std::vector<std::string> (*reads)(const Parameters&) = nullptr;
    bool reads_sequence = true, reads_seed = true;
    bool has_classes = false;  ///< pixels of one class (px mod m, py mod m) share what others do not
    /// A pixel's values are uniform and independent of other pixels' for every sequence, given its points: pictures
    /// have no bias and neighbours no shared error.
    bool independent_pixels = false;

    bool has_parameter(const std::string& parameter) const;
    bool reads_parameter(const std::string& parameter, const Parameters&) const;
};
const std::vector<DecorrelationEntry>& decorrelations();

/// Names of the parameters of all decorrelations, each once.
std::vector<std::string> parameter_names();

/// The first decorrelation's that has one of that name. Throws UsageError that lists the names of all.
const ParameterEntry& find_parameter(const std::string& name);

/// Throws UsageError for a name that is no decorrelation's parameter and a value that find_parameter() does not allow,
/// even where nothing reads it. mu above 1 is not an error.
void check_parameters(const Parameters&);

/// Throws UsageError unless every aligned group of s dimensions of the sequence is a net in base 2.
void require_net(const std::string& decorrelation, const Sequence&, unsigned s);
/// log2(N). Throws UsageError unless N is a power of two.
unsigned require_power_of_two(const std::string& decorrelation, std::uint64_t spp);

/// Throws UsageError for an unknown name (listing the valid ones) and as check_spp() and check_parameters() do. mu
/// above 1 is clamped to 1; Decorrelation::warning() says so. Without a sequence: for the default one, sobol.
std::unique_ptr<Decorrelation> make_decorrelation(const std::string& name, const Parameters&, const SampleSet&,
                                                  const Sequence&);
std::unique_ptr<Decorrelation> make_decorrelation(const std::string& name, const Parameters&, const SampleSet&);

/// The entry of that name. Throws UsageError that lists the valid names.
const DecorrelationEntry& find_decorrelation(const std::string& name);

}  // namespace raycache::tracer
