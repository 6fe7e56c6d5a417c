// Numbers that are the same on every machine: a small generator and a sine that does not ask the C library.
#pragma once

#include <cmath>
#include <cstdint>

#include "tracer/vec.hpp"

namespace raycache::tracer::modelling {

/// One number per full expression, or in braces: else the compiler chooses which comes first.
/// PCG32 (O'Neill 2014, XSH-RR 64/32). Every part of a scene owns one with its own stream, so that more detail in
/// one part moves nothing in another.
class Random {
public:
    explicit Random(std::uint64_t stream, std::uint64_t seed = 0x5EED0FC0A57A2DULL) : increment_(2 * stream + 1) {
        bits();
        state_ += seed;
        bits();
    }

    std::uint32_t bits() {
        const std::uint64_t old = state_;
        state_ = old * 6364136223846793005ULL + increment_;
        const auto mixed = static_cast<std::uint32_t>(((old >> 18) ^ old) >> 27);
        const auto turn = static_cast<std::uint32_t>(old >> 59);
        return (mixed >> turn) | (mixed << ((32 - turn) & 31));
    }
    /// In [0, 1).
    float unit() { return static_cast<float>(bits() >> 8) * 0x1p-24F; }
    /// In [low, high).
    float in(float low, float high) { return low + (high - low) * unit(); }
    /// In [0, count).
    std::uint32_t below(std::uint32_t count) {
        return static_cast<std::uint32_t>((static_cast<std::uint64_t>(bits()) * count) >> 32);
    }
    /// A point of the cube [-size, size]^3.
    Vec3 jitter(float size) {
        const float x = in(-size, size), y = in(-size, size), z = in(-size, size);
        return {x, y, z};
    }

private:
    std::uint64_t state_ = 0, increment_;
};

struct CosSin {
    float cos, sin;
};

/// Cosine and sine of an angle in turns (1 = full circle), from additions and products only: a Taylor series on an
/// eighth of a turn, exact to double rounding.
inline CosSin cos_sin(double turns) {
    const double t = turns - std::floor(turns + 0.5);
    const double quarter = std::floor(t * 4 + 0.5);
    const double x = (t - quarter / 4) * 6.283185307179586476925, x2 = x * x;
    double c = 0, s = 0;
    for (int i = 8; i >= 1; --i) {
        c = (c + 1) * -x2 / ((2 * i) * (2 * i - 1));
        s = (s + 1) * -x2 / ((2 * i) * (2 * i + 1));
    }
    c += 1;
    s = x * (s + 1);
    switch (static_cast<int>(quarter) & 3) {
        case 0:
            return {static_cast<float>(c), static_cast<float>(s)};
        case 1:
            return {static_cast<float>(-s), static_cast<float>(c)};
        case 2:
            return {static_cast<float>(-c), static_cast<float>(-s)};
        default:
            return {static_cast<float>(s), static_cast<float>(-c)};
    }
}

}  // namespace raycache::tracer::modelling
