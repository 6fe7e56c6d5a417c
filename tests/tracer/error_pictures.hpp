// Pictures whose errors are known, for tests of what is measured on them.
#pragma once

#include <cmath>
#include <functional>
#include <span>

#include "tests/tracer/test_meshes.hpp"
#include "tracer/quality/error_measures.hpp"

namespace raycache::tracer::test {

inline Image picture(std::uint32_t width, std::uint32_t height,
                     const std::function<Vec3(std::uint32_t, std::uint32_t)>& at) {
    Image image{width, height, {}};
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x) image.pixels.push_back(at(x, y));
    return image;
}

inline Image plain(std::uint32_t width, std::uint32_t height, float value) {
    return picture(width, height, [&](auto, auto) { return Vec3{value, value, value}; });
}

/// Of a picture of ones, known without error.
inline Reference ones(std::uint32_t width, std::uint32_t height) {
    return {plain(width, height, 1), plain(width, height, 0), "test"};
}

inline ErrorMeasures measure(const Image& image, const Reference& reference) {
    return measure_errors(std::span(&image, 1), reference);
}

/// Grey noise of the given deviation, uniform.
inline Image noisy(std::uint32_t width, std::uint32_t height, Random& random, float mean, float deviation) {
    const float half = deviation * std::sqrt(3.0F);
    return picture(width, height, [&](auto, auto) {
        const float v = mean + random.between(-half, half);
        return Vec3{v, v, v};
    });
}

/// Two independent halves a and b as a reference.
inline Reference reference_of(const Image& a, const Image& b) {
    Reference reference{a, a, "test"};
    for (std::size_t p = 0; p < a.pixels.size(); ++p) {
        reference.mean.pixels[p] = 0.5F * (a.pixels[p] + b.pixels[p]);
        reference.half_difference.pixels[p] = 0.5F * (a.pixels[p] - b.pixels[p]);
    }
    return reference;
}

}  // namespace raycache::tracer::test
