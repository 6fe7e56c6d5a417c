// Nested uniform scrambling in base 2: at every node of the binary tree of digits the two halves are swapped or not, at
// random. A. B. Owen, "Randomly permuted (t,m,s)-nets and (t,s)-sequences", 1995. Every dyadic interval keeps its
// number of points, so a net stays a net, and each point alone is uniform over the keys.
//
// Hash-based: S. Laine, T. Karras, "Stratified sampling for stochastic transparency", CGF 30(4), 2011; B. Burley,
// "Practical hash-based Owen scrambling", JCGT 9(4), 2020. With the bits reversed, adding a key and x ^= x * even let
// each bit depend on lower ones only. The multipliers are those of N. Vegdahl, "Building a better LK hash", 2021, which
// mixes the deeper levels better than Burley's; both key words are random here, so that adding the first makes each
// point exactly uniform.
#pragma once

#include <cstdint>

#include "tracer/sampling/hash.hpp"

namespace raycache::tracer {

constexpr std::uint32_t reverse_bits(std::uint32_t x) {
    x = (x >> 16) | (x << 16);
    x = ((x & 0x00FF00FFU) << 8) | ((x >> 8) & 0x00FF00FFU);
    x = ((x & 0x0F0F0F0FU) << 4) | ((x >> 4) & 0x0F0F0F0FU);
    x = ((x & 0x33333333U) << 2) | ((x >> 2) & 0x33333333U);
    return ((x & 0x55555555U) << 1) | ((x >> 1) & 0x55555555U);
}

/// Owen-scrambled x, a bijection of x. Its top k bits depend on the top k bits of x only. Uses words 0 and 1 of the
/// key.
constexpr std::uint32_t owen_scramble(std::uint32_t x, const HashWords& key) {
    x = reverse_bits(x);
    x ^= x * 0x3D20ADEAU;
    x += key[0];
    x *= key[1] | 1U;
    x ^= x * 0x05526C56U;
    x ^= x * 0x53A22864U;
    return reverse_bits(x);
}

/// A random permutation of the indices of a sequence that maps each aligned block of 2^m indices to an aligned block:
/// the same function, read as an order. Pairs of dimensions shuffled by different keys can be put side by side
/// ("padding") without depending on each other; where N is a power of two, all N points of a digital net are still
/// those of one net. For another N the points are those of blocks of the sizes of N's binary digits.
constexpr std::uint32_t shuffle_index(std::uint32_t index, const HashWords& key) { return owen_scramble(index, key); }

}  // namespace raycache::tracer
