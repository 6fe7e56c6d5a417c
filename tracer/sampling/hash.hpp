// Random numbers as a function of where they are used, with no state: pcg4d, the four-word hash of
// M. Jarzynski and M. Olano, "Hash Functions for GPU Rendering", JCGT 9(3), 2020,
// https://jcgt.org/published/0009/03/02/. Integers only, so every machine computes the same numbers.
//
// Trap: do not replace it by a Wang hash of `dimension ^ seed`. Two dimensions of that hash are strongly correlated
// (tests/tracer/sampling_hash.cpp measures both).
#pragma once

#include <array>
#include <cstdint>

namespace raycache::tracer {

using HashWords = std::array<std::uint32_t, 4>;

/// pcg4d: a linear congruential step per word, then two rounds that multiply each word into another. A bijection, so
/// different inputs give different outputs.
constexpr HashWords pcg4d(HashWords v) {
    const auto mix = [&v] {
        v[0] += v[1] * v[3];
        v[1] += v[2] * v[0];
        v[2] += v[0] * v[1];
        v[3] += v[1] * v[2];
    };
    for (std::uint32_t& word : v) word = word * 1664525U + 1013904223U;
    mix();
    for (std::uint32_t& word : v) word ^= word >> 16;
    mix();
    return v;
}

/// What a random number is for. One seed gives unrelated numbers for different purposes.
enum class HashPurpose : std::uint32_t {
    pixel_offset = 1,    ///< xi_{p,d}: shared by cranley-patterson and micro-jitter
    independent = 2,     ///< the random decorrelation
    sample_indices = 3,  ///< choose_sample_indices
    pixel_scramble = 4,  ///< per pixel: owen, net-micro-jitter
    class_offset = 5,    ///< per pixel class: interleaved
    class_scramble = 6,  ///< per pixel class: net-micro-jitter-fast
    set_shuffle = 7,     ///< order of the points in one set of a padded sequence
    point_scramble = 8,  ///< scrambling inside a sequence
    point_numbers = 9,   ///< the random sequence; the free digits of pmj02
    mask_shift = 10,     ///< blue-noise: where the mask lies in each dimension
    mask_detail = 11,    ///< blue-noise: the digits below a mask's rank, and the mask's own first pattern
    window_blocks = 12,  ///< which blocks of sample indices an estimate is of
    window_places = 13,  ///< where in the picture their windows lie
};

/// A family of 2^96 random 32-bit words, picked by all 64 bits of a seed and by the purpose.
class HashKey {
public:
    constexpr HashKey(std::uint64_t seed, HashPurpose purpose)
        : key_(pcg4d({static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32),
                      static_cast<std::uint32_t>(purpose), 0})) {}

    /// Four random words for the place (a, b, c).
    constexpr HashWords words(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
        return pcg4d({a + key_[0], b + key_[1], c + key_[2], key_[3]});
    }

private:
    HashWords key_;
};

/// xi_{p,d}, uniform in 0 … 2^32 - 1: the offset of pixel p in dimension d, the same for every sample index.
constexpr std::uint32_t pixel_offset(const HashKey& key, std::uint32_t pixel, std::uint32_t dimension) {
    return key.words(pixel, dimension, 0)[0];
}

}  // namespace raycache::tracer
