#include "naive_place.hpp"

#include <algorithm>

namespace raycache::cachesim::test {

namespace {

/// How many bits number `count` things; at least 1.
unsigned bits_for(std::uint64_t count) {
    unsigned bits = 1;
    while (bits < 63 && (std::uint64_t{1} << bits) < count) ++bits;
    return bits;
}

std::uint64_t naive_fold(std::uint64_t value, unsigned k) {
    std::uint64_t h = 0;
    for (unsigned shift = 0; shift < 64; shift += k) h ^= value >> shift;
    return h;
}

/// The lowest `bits` bits, highest first.
std::string bit_string(std::uint64_t value, unsigned bits) {
    std::string s;
    for (unsigned bit = bits; bit-- > 0;) s += (value >> bit & 1) ? '1' : '0';
    return s;
}

std::uint64_t from_bits(const std::string& bits) {
    std::uint64_t value = 0;
    for (const char bit : bits) value = value * 2 + (bit == '1');
    return value;
}

/// P(high, low) for `count` = 16, 32 or 64.
std::uint64_t naive_polynomial(std::uint64_t high, std::uint64_t low, std::uint64_t count) {
    if (count == 16) return naive_remainder(bit_string(high, 64) + bit_string(low, 4), "10011");
    if (count == 32) return naive_remainder(bit_string(high, 15) + bit_string(low, 5), "100101");
    return naive_remainder(bit_string(high, 19) + bit_string(low, 6), "1000011");
}

std::uint64_t naive_set_of_slice(const CacheGeometry& g, std::uint64_t line, std::uint64_t line_in_slice) {
    switch (g.index) {
        case SetIndex::modulo:
            return line_in_slice % g.sets;
        case SetIndex::xor_fold:
            return naive_fold(line_in_slice, bits_for(g.sets)) % g.sets;
        case SetIndex::ipoly:
            return naive_polynomial(line_in_slice / g.sets, line_in_slice % g.sets, g.sets);
        case SetIndex::parity:
            break;
    }
    std::string set;
    for (const std::uint64_t mask : g.index_masks) {
        const std::string masked = bit_string((line * g.line_bytes) & mask, 64);
        set = (std::count(masked.begin(), masked.end(), '1') % 2 ? '1' : '0') + set;
    }
    return from_bits(set);
}

NaivePlace naive_ipoly_slice(const CacheGeometry& g, std::uint64_t line) {
    const std::string address = bit_string(line * g.line_bytes, 64);  // bit b stands at 63 - b
    std::string low, rest;
    for (const std::uint32_t bit : g.slice_bits) low = address[63 - bit] + low;
    for (unsigned bit = 0; bit < 64; ++bit)
        if ((std::uint64_t{1} << bit) >= g.line_bytes &&
            std::find(g.slice_bits.begin(), g.slice_bits.end(), bit) == g.slice_bits.end())
            rest = address[63 - bit] + rest;
    const std::uint64_t high = from_bits(address.substr(0, 64 - g.slice_hash_from));
    return {naive_polynomial(high, from_bits(low), g.slices), naive_set_of_slice(g, line, from_bits(rest))};
}

}  // namespace

std::uint64_t naive_remainder(std::string dividend, const std::string& divisor) {
    for (std::size_t at = 0; at + divisor.size() <= dividend.size(); ++at) {
        if (dividend[at] == '0') continue;
        for (std::size_t i = 0; i < divisor.size(); ++i) dividend[at + i] = dividend[at + i] == divisor[i] ? '0' : '1';
    }
    return from_bits(dividend);
}

NaivePlace naive_place(const CacheGeometry& g, std::uint64_t line) {
    if (g.slices == 1) return {0, naive_set_of_slice(g, line, line)};
    if (g.slice_hash == SliceHash::ipoly) return naive_ipoly_slice(g, line);
    const std::uint64_t lines_per_piece = g.interleave_bytes / g.line_bytes;
    std::uint64_t h = line / lines_per_piece;
    if (g.slice_hash == SliceHash::xor_fold) h = naive_fold(h, bits_for(g.slices));
    return {h % g.slices, naive_set_of_slice(g, line, h / g.slices * lines_per_piece + line % lines_per_piece)};
}

std::uint64_t naive_set(const CacheGeometry& geometry, std::uint64_t line) {
    const NaivePlace place = naive_place(geometry, line);
    return place.slice * geometry.sets + place.set;
}

}  // namespace raycache::cachesim::test
