// Nested uniform scrambling in base 2: at every node of the binary tree of digits the two halves are swapped or not, at
// random. A. B. Owen, "Randomly permuted (t,m,s)-nets and (t,s)-sequences", 1995. Every dyadic interval keeps its
// number of points, so a net stays a net, and each point alone is uniform over the keys.
//
// Hash-based: S. Laine, T. Karras, "Stratified sampling for stochastic transparency", CGF 30(4), 2011; B. Burley,
// "Practical hash-based Owen scrambling", JCGT 9(4), 2020. With the bits reversed, adding a key, odd factors and
// x ^= x * even let each bit depend on lower ones only. The fixed multipliers are those of N. Vegdahl, "Building a
// better LK hash", 2021. Three key words are random here: adding the first makes each point alone exactly uniform. A
// few key bits decide the upper levels, so there are fewer trees than Owen has: 2^10 instead of 2^15 for the first four
// levels.
//
// Trap: the four lowest bits of pcg4d's words, which would decide the first levels, depend on each other between
// dimensions of a pixel (chi-square 9403 for 255 degrees of freedom). They are folded with the upper half.
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

/// Owen-scrambled x, a bijection of x. Its top k bits depend on the top k bits of x only. Uses words 0 to 2 of the key.
constexpr std::uint32_t owen_scramble(std::uint32_t x, const HashWords& key) {
    const auto folded = [&key](unsigned word) { return key[word] ^ (key[word] >> 16); };
    x = reverse_bits(x);
    x ^= x * 0x3D20ADEAU;
    x += folded(0);
    x *= folded(1) | 1U;
    x ^= x * (folded(2) << 1);
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
