// mu in fixed point: a window's width as a multiple of 2^-32, so that jitter has no float rounding. A mu too small to
// move a float still moves a point, and one that rounds to 0 moves none.
#pragma once

#include <cstdint>

namespace raycache::tracer {

class FixedMu {
public:
    /// Precondition: 0 <= mu <= 1.
    explicit FixedMu(double mu) : mu_(static_cast<std::int64_t>(mu * 0x1p32 + 0.5)) {}

    /// floor(mu * xi), xi in [0, 1). The product is below 2^64.
    std::uint32_t one_sided(std::uint32_t xi) const {
        return static_cast<std::uint32_t>((std::uint64_t{xi} * static_cast<std::uint64_t>(mu_)) >> 32);
    }
    /// floor(mu * xi), xi in [-1/2, 1/2). The product is at least -2^63, which just fits.
    std::uint32_t symmetric(std::uint32_t xi) const {
        return static_cast<std::uint32_t>(((std::int64_t{xi} - (std::int64_t{1} << 31)) * mu_) >> 32);
    }

private:
    std::int64_t mu_;  ///< mu * 2^32, 0 … 2^32
};

}  // namespace raycache::tracer
