// Line -> slice and set of a level, for any number of slices and sets.
//
// Slices. 1: everything. Otherwise, with g = address / interleave_bytes, k = bits of (slices - 1):
//   modulo     h = g
//   xor_fold   h = g xor (g >> k) xor (g >> 2k) xor …, a bijection of g
//              slice = h mod slices; line in the slice = (h div slices) * lines per interleave + line mod that
//   ipoly      low = the address bits slice_bits, lowest first; high = address >> slice_hash_from
//              slice = P(high, low); line in the slice = the line number without slice_bits
// So a slice's lines are numbered without the bits that chose the slice.
//
// Sets, from the line in the slice, k = bits of (sets - 1), at least 1:
//   modulo     line mod sets
//   xor_fold   (line xor (line >> k) xor (line >> 2k) xor …) mod sets
//   ipoly      P(line >> k, line mod 2^k)
//   parity     bit i = parity(byte address & index_masks[i]), the address of the whole line number, not of the slice's
//
// P(high, low) is the remainder of the bit string high:low (k low bits) modulo t^4+t+1, t^5+t^2+1 or t^6+t+1 for k = 4,
// 5, 6 (Rau 1991, "Pseudo-randomly interleaved memory"). GPGPU-Sim takes 15 bits of high for k = 5 and 19 for k = 6; so
// do we, and all bits for k = 4.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "cachesim/cache/divider.hpp"
#include "cachesim/cache/geometry.hpp"

namespace raycache::cachesim {

class LineMap {
public:
    /// The geometry must have passed find_problem(). `last_line`: the highest line that it will be asked for.
    explicit LineMap(const CacheGeometry&, std::uint64_t last_line = ~std::uint64_t{0});

    /// Whether the map is line & (sets - 1).
    bool is_low_bits() const { return form_ == Form::low_bits; }

    /// Where slice and set are exclusive-ors of bits of the line: what each value of each of its bytes contributes,
    /// from the lowest byte to that of `last_line`. Else empty.
    const std::vector<std::array<std::uint32_t, 256>>& tables() const { return tables_; }

    struct Place {
        std::uint32_t slice;
        std::uint64_t set;
    };
    Place place(std::uint64_t line) const {
        const std::uint64_t all = (*this)(line);
        const auto [slice, set] = by_sets_(all);
        return {static_cast<std::uint32_t>(slice), set};
    }

    /// slice * sets + set.
    std::uint64_t operator()(std::uint64_t line) const {
        switch (form_) {
            case Form::low_bits:
                return line & (sets_ - 1);
            case Form::linear: {
                std::uint32_t all = 0;
                for (const auto& table : tables_) {
                    all ^= table[line & 0xff];
                    line >>= 8;
                }
                return all;
            }
            case Form::hashed: {
                const auto [quotient, slice] = by_slices_(fold(line >> interleave_shift_, slice_fold_));
                const std::uint64_t in_piece = line & ((std::uint64_t{1} << interleave_shift_) - 1);
                const std::uint64_t line_in_slice = quotient << interleave_shift_ | in_piece;
                return slice * sets_ + by_sets_(fold(line_in_slice, set_fold_)).rest;
            }
            case Form::general:
                break;
        }
        return general(line);
    }

    /// As operator(), by the formulas above and nothing else.
    std::uint64_t general(std::uint64_t line) const;

private:
    enum class Form {
        low_bits,  ///< one slice, linear sets
        hashed,    ///< modulo and xor_fold only, any numbers of slices and sets
        linear,    ///< slice and set are exclusive-ors of bits of the line: tables_ holds those of each of its bytes
        general
    };

    /// value xor (value >> k) xor (value >> 2k) xor …; k = 64: the value.
    static std::uint64_t fold(std::uint64_t value, unsigned k) {
        for (unsigned shift = k; shift < 64; shift *= 2) value ^= value >> shift;
        return value;
    }
    std::uint64_t set(std::uint64_t line, std::uint64_t line_in_slice) const;

    CacheGeometry geometry_;
    std::uint64_t sets_;
    Divider by_sets_, by_slices_;
    int line_shift_, interleave_shift_ = 0;
    unsigned slice_fold_ = 64, set_fold_ = 64;
    std::uint64_t slice_bit_mask_ = 0;  ///< ipoly: slice_bits, as bits of the line number
    Form form_ = Form::general;
    std::vector<std::array<std::uint32_t, 256>> tables_;
};

/// P(high, low) for k = 4, 5 or 6 bits.
std::uint32_t polynomial_remainder(std::uint64_t high, std::uint32_t low, unsigned k);

}  // namespace raycache::cachesim
