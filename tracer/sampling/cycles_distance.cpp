#include "tracer/sampling/cycles_distance.hpp"

#include <algorithm>
#include <cmath>

namespace raycache::tracer {

std::uint64_t cycles_samples(const CyclesSettings& settings, std::uint64_t spp) {
    if (!settings.noise_threshold) return spp;
    if (settings.min_samples != 0) return std::min(spp, std::max<std::uint64_t>(4, settings.min_samples));
    // In single precision, as there: the last step of ceil() depends on it.
    float threshold = static_cast<float>(*settings.noise_threshold);
    if (threshold == 0) threshold = std::max(0.001F, 1.0F / static_cast<float>(spp));
    const float automatic = std::ceil(16.0F / std::pow(threshold, 0.3F));  // threshold >= 2^-149: below 2^50
    return std::min(spp, std::max<std::uint64_t>(4, static_cast<std::uint64_t>(automatic)));
}

double cycles_distance(const CyclesSettings& settings, std::uint64_t spp) {
    return settings.multiplier * (4.0 / std::sqrt(static_cast<double>(cycles_samples(settings, spp))));
}

}  // namespace raycache::tracer
