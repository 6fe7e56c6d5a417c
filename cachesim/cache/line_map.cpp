#include "cachesim/cache/line_map.hpp"

#include <algorithm>
#include <bit>

namespace raycache::cachesim {

namespace {

unsigned index_bits(std::uint64_t count) { return std::max(1u, static_cast<unsigned>(std::bit_width(count - 1))); }

/// The bits of `value` that `mask` lacks, moved together.
std::uint64_t without_bits(std::uint64_t value, std::uint64_t mask) {
    std::uint64_t result = 0;
    for (unsigned bit = 0, to = 0; bit < 64; ++bit) {
        if (mask >> bit & 1) continue;
        result |= (value >> bit & 1) << to++;
    }
    return result;
}

bool is_linear(const CacheGeometry& g) {
    return std::has_single_bit(g.slices) && std::has_single_bit(g.sets) && g.slices * g.sets <= std::uint64_t{1} << 31;
}

}  // namespace

std::uint32_t polynomial_remainder(std::uint64_t high, std::uint32_t low, unsigned k) {
    const std::uint32_t polynomial = k == 4 ? 0b10011 : k == 5 ? 0b100101 : 0b1000011;
    if (k == 5) high &= (1u << 15) - 1;
    if (k == 6) high &= (1u << 19) - 1;
    // Horner's rule from the highest bit: multiply by t, reduce, add the next bit.
    std::uint32_t rest = 0;
    const auto next = [&](std::uint32_t bit) {
        rest = rest << 1 | bit;
        if (rest >> k) rest ^= polynomial;
    };
    for (int bit = 63; bit >= 0; --bit) next(high >> bit & 1);
    for (int bit = static_cast<int>(k) - 1; bit >= 0; --bit) next(low >> bit & 1);
    return rest;
}

LineMap::LineMap(const CacheGeometry& geometry, std::uint64_t last_line)
    : geometry_(geometry),
      sets_(geometry.sets),
      by_sets_(geometry.sets),
      by_slices_(geometry.slices),
      line_shift_(std::countr_zero(geometry.line_bytes)) {
    for (const std::uint32_t bit : geometry.slice_bits)
        slice_bit_mask_ |= std::uint64_t{1} << (bit - static_cast<unsigned>(line_shift_));
    const bool hashed_slices = geometry.slices == 1 || geometry.slice_hash != SliceHash::ipoly;
    if (geometry.index == SetIndex::xor_fold) set_fold_ = index_bits(sets_);
    if (geometry.slices > 1 && hashed_slices) {
        interleave_shift_ = std::countr_zero(geometry.interleave_bytes) - line_shift_;
        if (geometry.slice_hash == SliceHash::xor_fold) slice_fold_ = index_bits(geometry.slices);
    }
    if (!is_linear(geometry)) {
        if (hashed_slices && (geometry.index == SetIndex::modulo || geometry.index == SetIndex::xor_fold))
            form_ = Form::hashed;
        return;
    }
    if (geometry.slices == 1 && geometry.index == SetIndex::modulo) {
        form_ = Form::low_bits;
        return;
    }
    form_ = Form::linear;
    const int bits = std::min(64 - line_shift_, static_cast<int>(std::bit_width(last_line)));
    tables_.resize(static_cast<std::size_t>(std::max(1, (bits + 7) / 8)));
    for (std::size_t byte = 0; byte < tables_.size(); ++byte)
        for (std::uint64_t value = 1; value < 256; ++value) {
            const std::uint64_t low = value & (~value + 1);  // the lowest bit alone
            tables_[byte][value] = value == low ? static_cast<std::uint32_t>(general(value << 8 * byte))
                                                : tables_[byte][low] ^ tables_[byte][value ^ low];
        }
}

std::uint64_t LineMap::set(std::uint64_t line, std::uint64_t line_in_slice) const {
    const unsigned k = index_bits(sets_);
    switch (geometry_.index) {
        case SetIndex::modulo:
            return by_sets_(line_in_slice).rest;
        case SetIndex::xor_fold:
            return by_sets_(fold(line_in_slice, k)).rest;
        case SetIndex::ipoly:
            return polynomial_remainder(line_in_slice >> k, static_cast<std::uint32_t>(line_in_slice % sets_), k);
        case SetIndex::parity:
            break;
    }
    std::uint64_t set = 0;
    for (std::size_t i = 0; i < geometry_.index_masks.size(); ++i)
        set |= std::uint64_t(std::popcount((line << line_shift_) & geometry_.index_masks[i]) & 1) << i;
    return set;
}

std::uint64_t LineMap::general(std::uint64_t line) const {
    const std::uint64_t slices = geometry_.slices;
    if (slices == 1) return set(line, line);
    if (geometry_.slice_hash == SliceHash::ipoly) {
        const std::uint64_t address = line << line_shift_;
        std::uint32_t low = 0;
        for (std::size_t i = 0; i < geometry_.slice_bits.size(); ++i)
            low |= static_cast<std::uint32_t>(address >> geometry_.slice_bits[i] & 1) << i;
        const std::uint64_t slice = polynomial_remainder(address >> geometry_.slice_hash_from, low, index_bits(slices));
        return slice * sets_ + set(line, without_bits(line, slice_bit_mask_));
    }
    const int shift = std::countr_zero(geometry_.interleave_bytes) - line_shift_;
    const std::uint64_t piece = line >> shift;
    const std::uint64_t h = geometry_.slice_hash == SliceHash::xor_fold ? fold(piece, index_bits(slices)) : piece;
    const auto [quotient, slice] = by_slices_(h);
    return slice * sets_ + set(line, quotient << shift | (line & ((std::uint64_t{1} << shift) - 1)));
}

}  // namespace raycache::cachesim
