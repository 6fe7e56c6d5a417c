// Variants of micro-jitter that are no sampling strategies because they lose: kept to measure by how much.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "tracer/sampling/measures/test_scenes.hpp"
#include "tracer/sampling/sequence.hpp"

namespace raycache::tracer {

enum class JitterVariant {
    wrap,       ///< micro-jitter as it is: modulo 1
    clamp,      ///< beyond 0 or 1: held at the border
    reflect,    ///< beyond 0 or 1: mirrored at the border
    per_sample  ///< modulo 1, but with a new xi for every sample of a pixel
};

class JitterVariantPoints final : public PixelPoints {
public:
    /// The first n points of a sequence, symmetric jitter of width mu, 0 … 1.
    JitterVariantPoints(JitterVariant, const Sequence&, std::uint32_t dimensions, std::uint32_t n, double mu,
                        std::uint64_t seed);
    void fill(std::uint32_t pixel, std::span<double> points) const override;

private:
    JitterVariant variant_;
    std::uint32_t dimensions_;
    double mu_;
    std::uint64_t seed_;
    std::vector<double> base_;
};

}  // namespace raycache::tracer
