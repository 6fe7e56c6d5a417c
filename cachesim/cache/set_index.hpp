// Line number -> set, for any number of sets.
//
//   modulo     set = line mod sets
//   xor_fold   set = h mod sets,  h = line xor (line >> k) xor (line >> 2k) xor …,  k = bits of (sets - 1), at least 1
//
// For 2^k sets the low k bits of h are the exclusive-or of all k-bit groups of the line number, the usual folded index.
// h is a bijection of the line number, so no set is favoured when `sets` is no power of two.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>

#include "cachesim/gpus/gpu.hpp"

namespace raycache::cachesim {

class SetIndexer {
public:
    SetIndexer(std::uint64_t sets, SetIndex function)
        : sets_(sets),
          reciprocal_(sets == 1 ? ~std::uint64_t{0} : static_cast<std::uint64_t>((Wide{1} << 64) / sets)),
          fold_(function == SetIndex::xor_fold ? std::max(1, static_cast<int>(std::bit_width(sets - 1))) : 64) {}

    std::uint64_t operator()(std::uint64_t line) const {
        for (int shift = fold_; shift < 64; shift *= 2) line ^= line >> shift;
        if ((sets_ & (sets_ - 1)) == 0) return line & (sets_ - 1);
        // line mod sets without a division: floor(line * reciprocal / 2^64) is the quotient or one less.
        const auto quotient = static_cast<std::uint64_t>((Wide{line} * reciprocal_) >> 64);
        const std::uint64_t rest = line - quotient * sets_;
        return rest < sets_ ? rest : rest - sets_;
    }

private:
    __extension__ using Wide = unsigned __int128;
    std::uint64_t sets_, reciprocal_;
    int fold_;  ///< k, or 64 for none
};

}  // namespace raycache::cachesim
