#include "tracer/sampling/decorrelations/net_bits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace raycache::tracer {

NetBits::NetBits(const std::string& decorrelation, unsigned s, const SampleSet& samples, const Sequence& sequence) {
    require_net(decorrelation, sequence, s);
    const unsigned m = require_power_of_two(decorrelation, samples.spp);
    const std::uint32_t used = samples.dimensions == 0 ? sequence.dimensions() : samples.dimensions;
    for (std::uint32_t first = 0; first < used; first += s) {
        const unsigned k = sequence.equal_cell_bits(first, s, m);
        masks_.insert(masks_.end(), s, k == 0 ? 0 : ~0U << (32 - k));
        least_ = std::min(least_, k);
        most_ = std::max(most_, k);
    }
}

std::string NetBits::parameters() const {
    const double finest = std::ldexp(1.0, -static_cast<int>(most_)),
                 coarsest = std::ldexp(1.0, -static_cast<int>(least_));
    if (least_ == most_) return fmt::format("k={} mu={}", most_, finest);
    return fmt::format("k={}..{} mu={}..{}", least_, most_, finest, coarsest);
}

}  // namespace raycache::tracer
