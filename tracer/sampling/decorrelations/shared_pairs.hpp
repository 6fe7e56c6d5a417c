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
    unsigned bits() const { return bits_; }  ///< shared, of all dimensions together
    /// What may be shared at no cost: the largest number for which each joint cell of a pixel's N points holds equally
    /// many. Of several pairs that of the best one: together they have no more than log2(N).
    unsigned free_bits() const { return free_; }
    /// "bits=6 free=6"
    std::string parameters() const;
    /// Where more is shared than is free.
    std::string warning() const;

private:
    void share(std::uint32_t dimension, unsigned bits);

    std::vector<std::uint32_t> masks_;
    unsigned bits_ = 0, free_ = 0;
};

}  // namespace raycache::tracer
