// Least recently used, for up to 64 ways that are often searched in vain: as LruFewWays, but every look-up passes over
// the whole set. That takes no branch that depends on the data, which pays where most look-ups go deep.
#pragma once

#include <emmintrin.h>
#include <smmintrin.h>

#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "cachesim/cache/request.hpp"

namespace raycache::cachesim {

/// Up to 16 * Groups ways. Line ids must be below 2^(32 - sectors), see LruFewWays::fits().
template <unsigned Groups>
class LruMediumWays {
public:
    LruMediumWays(std::uint64_t sets, std::uint64_t ways, unsigned sectors_per_line)
        : oldest_(std::uint64_t{1} << (ways - 1)), sector_bits_(sectors_per_line), sets_(sets) {}

    void prefetch(std::uint64_t set, const Request&) const {
        for (unsigned block = 0; block < blocks; block += 4) __builtin_prefetch(&sets_[set].of_ways[block], 1);
    }

    std::uint32_t access(std::uint64_t set, const Request& request) {
        Block* const block = sets_[set].of_ways.data();
        const std::uint32_t tag = request.id << sector_bits_;
        const std::uint32_t sector_mask = (1u << sector_bits_) - 1;
        const __m128i tag_mask = _mm_set1_epi32(static_cast<int>(~sector_mask));
        const __m128i wanted = _mm_set1_epi32(static_cast<int>(tag));
        const auto match = [&](unsigned b) { return _mm_cmpeq_epi32(_mm_and_si128(block[b].lanes, tag_mask), wanted); };
        std::uint64_t found = oldest_;  // the way to replace if no other matches
        for (unsigned b = 0; b < blocks; b += 4) {
            const __m128i low = _mm_packs_epi32(match(b), match(b + 1)),
                          high = _mm_packs_epi32(match(b + 2), match(b + 3));
            const auto lanes = static_cast<std::uint32_t>(_mm_movemask_epi8(_mm_packs_epi16(low, high)));
            found |= std::uint64_t{lanes} << (4 * b);
        }
        const auto way = static_cast<std::uint32_t>(std::countr_zero(found));
        const std::uint32_t word = block[way / 4].word(way % 4);
        const std::uint32_t old = (word & ~sector_mask) == tag ? word & sector_mask : 0;

        // Ways 0 … way - 1 move one place up, the newest goes to place 0.
        const __m128i last = _mm_set1_epi32(static_cast<int>(way));
        __m128i place = _mm_setr_epi32(0, 1, 2, 3);
        __m128i before = _mm_set1_epi32(static_cast<int>(tag | old | request.sectors));
        for (unsigned b = 0; b < blocks; ++b) {
            const __m128i here = block[b].lanes;
            block[b].lanes = _mm_blendv_epi8(_mm_alignr_epi8(here, before, 12), here, _mm_cmpgt_epi32(place, last));
            before = here;
            place = _mm_add_epi32(place, _mm_set1_epi32(4));
        }
        return request.sectors & ~old;
    }

private:
    static constexpr unsigned blocks = 4 * Groups;
    struct Block {
        __m128i lanes = _mm_setzero_si128();
        std::uint32_t word(unsigned lane) const { return reinterpret_cast<const std::uint32_t*>(&lanes)[lane]; }
    };
    struct Set {
        std::array<Block, 4 * Groups> of_ways;
    };

    std::uint64_t oldest_;  ///< bit of the last way
    unsigned sector_bits_;
    std::vector<Set> sets_;
};

}  // namespace raycache::cachesim
