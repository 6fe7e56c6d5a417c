#include "tracer/sampling/measures/jitter_variants.hpp"

#include <algorithm>
#include <cmath>

#include "tracer/sampling/hash.hpp"

namespace raycache::tracer {
namespace {

constexpr double last = 1 - 0x1p-32;

double inside(JitterVariant variant, double y) {
    switch (variant) {
        case JitterVariant::clamp:
            return std::clamp(y, 0.0, last);
        case JitterVariant::reflect:
            return y < 0 ? -y : y > 1 ? 2 - y : std::min(y, last);
        default:
            return std::min(y - std::floor(y), last);
    }
}

}  // namespace

JitterVariantPoints::JitterVariantPoints(JitterVariant variant, const Sequence& sequence, std::uint32_t dimensions,
                                         std::uint32_t n, double mu, std::uint64_t seed)
    : variant_(variant), dimensions_(dimensions), mu_(mu), seed_(seed) {
    for (std::uint32_t i = 0; i < n; ++i)
        for (std::uint32_t d = 0; d < dimensions; ++d) base_.push_back(sequence.sample(i, d) * 0x1p-32);
}

void JitterVariantPoints::fill(std::uint32_t pixel, std::span<double> points) const {
    const HashKey constant(seed_, HashPurpose::pixel_offset), changing(seed_, HashPurpose::independent);
    for (std::uint32_t d = 0; d < dimensions_; ++d) {
        double xi = pixel_offset(constant, pixel, d) * 0x1p-32 - 0.5;
        std::uint32_t i = 0;
        for (std::size_t at = d; at < base_.size(); at += dimensions_, ++i) {
            if (variant_ == JitterVariant::per_sample) xi = changing.words(pixel, i, d)[0] * 0x1p-32 - 0.5;
            points[at] = inside(variant_, base_[at] + mu_ * xi);
        }
    }
}

}  // namespace raycache::tracer
