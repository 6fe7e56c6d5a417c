// How many leading bits of its points a net can share between pixels without bias.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tracer/sampling/decorrelation.hpp"

namespace raycache::tracer {

/// For each set of s dimensions, the k of net-micro-jitter: the largest one such that all 2^(k s) cells of side 2^-k
/// hold equally many of the first N points (Sequence::equal_cell_bits), computed set by set.
class NetBits {
public:
    /// Throws UsageError unless N is a power of two and the sequence a net in base 2 in s dimensions jointly.
    NetBits(const std::string& decorrelation, unsigned s, const SampleSet&, const Sequence&);

    /// The leading k bits of `dimension` as a mask; 0 for k = 0.
    std::uint32_t mask(std::uint32_t dimension) const { return masks_[dimension]; }
    /// "k=3 mu=0.125", or "k=1..3 mu=0.125..0.5" where sets of the path's dimensions differ.
    std::string parameters() const;

private:
    std::vector<std::uint32_t> masks_;
    unsigned least_ = 32, most_ = 0;
};

}  // namespace raycache::tracer
