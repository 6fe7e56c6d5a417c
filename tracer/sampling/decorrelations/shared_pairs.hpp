// Which pairs of a path's dimensions net-micro-jitter shares between pixels, and how many of their leading bits cost
// nothing. docs/sampling.md has the theorem.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tracer/sampling/decorrelation.hpp"

namespace raycache::tracer {

/// A pair by the name of the decision that it makes in a path (tracer/paths/integrators/path_integrator.hpp).
struct NamedPair {
    const char* name;
    std::uint32_t first;  ///< of its two dimensions
};
inline constexpr NamedPair named_pairs[] = {{"camera", 0}, {"light0", 2}, {"first-bounce", 4}};

/// "first-bounce", "first-bounce+light0", "4+8": first dimensions of pairs, even ones. Throws UsageError.
std::vector<std::uint32_t> parse_pairs(const std::string&);

/// The leading bits that all pixels share, by dimension.
class SharedPairs {
public:
    /// `pairs`: first dimensions; those beyond samples.dimensions are left out. `bits`: dealt to the dimensions of all
    /// pairs in turn, at most 32 each; negative: of each pair as many as are free. Throws UsageError unless N is a power
    /// of two and the sequence a net in base 2 in pairs.
    SharedPairs(const std::vector<std::uint32_t>& pairs, int bits, const SampleSet&, const Sequence&);

    std::uint32_t mask(std::uint32_t dimension) const { return dimension < masks_.size() ? masks_[dimension] : 0; }
    unsigned bits() const;  ///< shared, of all dimensions together
    /// "bits=6 free=6"; free: what the best of the pairs may share at no cost by itself. The joint cells of these bits
    /// hold equally many of a pixel's N points: of both dimensions alike, then as many more of one. At most log2(N).
    std::string parameters() const;
    /// Where the joint cells of all shared bits do not hold equally many points, or that is not known.
    std::string warning() const;

private:
    bool is_free(unsigned m, const Sequence&) const;

    std::vector<unsigned> bits_;  ///< by dimension
    std::vector<std::uint32_t> masks_;
    unsigned most_free_ = 0;
    bool is_free_ = true;
};

}  // namespace raycache::tracer
