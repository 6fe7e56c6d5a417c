// Least recently used, for few ways: a set is an array of its lines in order of last use, newest first, searched and
// shifted by vector instructions. Tag and sectors share a 32-bit word, so line numbers must be below 2^(32 - sectors).
#pragma once

#include <emmintrin.h>
#include <smmintrin.h>

#include <bit>
#include <cstdint>
#include <vector>

namespace raycache::cachesim {

class LruFewWays {
public:
    LruFewWays(std::uint64_t sets, std::uint64_t ways, unsigned sectors_per_line)
        : ways_(static_cast<std::uint32_t>(ways)),
          blocks_((ways_ + 3) / 4),
          sector_bits_(sectors_per_line),
          words_(sets * blocks_, Block{}) {}

    /// Whether lines below `lines` leave room for the sectors in a word.
    static bool fits(std::uint64_t lines, unsigned sectors_per_line) {
        return sectors_per_line < 32 && lines <= std::uint64_t{1} << (32 - sectors_per_line);
    }

    void prefetch(std::uint64_t set, std::uint32_t /*line*/) const { __builtin_prefetch(&words_[set * blocks_], 1); }

    /// An empty way is the word 0: no sectors. If it is taken for line 0 it is filled as any other empty way would be.
    std::uint32_t access(std::uint64_t set, std::uint32_t line, std::uint32_t sectors) {
        Block* const block = &words_[set * blocks_];
        const std::uint32_t tag = line << sector_bits_;
        const std::uint32_t sector_mask = (1u << sector_bits_) - 1;
        const __m128i tag_mask = _mm_set1_epi32(static_cast<int>(~sector_mask));
        const __m128i wanted = _mm_set1_epi32(static_cast<int>(tag));

        const __m128i first = block[0].lanes;
        __m128i before = first;
        std::uint32_t found = match(first, tag_mask, wanted);
        if (found && first_lane(found) < ways_) {
            const std::uint32_t lane = first_lane(found);
            const std::uint32_t old = block[0].words()[lane];
            const __m128i shifted = _mm_slli_si128(first, 4);
            const __m128i kept = _mm_blendv_epi8(first, shifted, up_to(lane));
            block[0].lanes = _mm_insert_epi32(kept, static_cast<int>(old | sectors), 0);
            return sectors & ~old;
        }
        std::uint32_t old = 0;
        for (std::uint32_t b = 1; b < blocks_; ++b) {
            const __m128i here = block[b].lanes;
            const __m128i shifted = _mm_alignr_epi8(here, before, 12);
            found = match(here, tag_mask, wanted);
            if (found && b * 4 + first_lane(found) < ways_) {
                const std::uint32_t lane = first_lane(found);
                old = block[b].words()[lane];
                block[b].lanes = _mm_blendv_epi8(here, shifted, up_to(lane));
                break;
            }
            block[b].lanes = b + 1 < blocks_ ? shifted : _mm_blendv_epi8(here, shifted, up_to((ways_ - 1) & 3));
            before = here;
        }
        const std::uint32_t newest = tag | (old & sector_mask) | sectors;
        __m128i moved = _mm_insert_epi32(_mm_slli_si128(first, 4), static_cast<int>(newest), 0);
        if (blocks_ == 1) moved = _mm_blendv_epi8(first, moved, up_to(ways_ - 1));
        block[0].lanes = moved;
        return sectors & ~old;
    }

private:
    struct alignas(16) Block {
        __m128i lanes = _mm_setzero_si128();
        const std::uint32_t* words() const { return reinterpret_cast<const std::uint32_t*>(&lanes); }
    };

    static std::uint32_t match(__m128i words, __m128i tag_mask, __m128i wanted) {
        const __m128i equal = _mm_cmpeq_epi32(_mm_and_si128(words, tag_mask), wanted);
        return static_cast<std::uint32_t>(_mm_movemask_ps(_mm_castsi128_ps(equal)));
    }
    static std::uint32_t first_lane(std::uint32_t found) { return static_cast<std::uint32_t>(std::countr_zero(found)); }
    /// All bits of lanes 0 … lane.
    static __m128i up_to(std::uint32_t lane) {
        return _mm_cmplt_epi32(_mm_setr_epi32(0, 1, 2, 3), _mm_set1_epi32(static_cast<int>(lane) + 1));
    }

    std::uint32_t ways_, blocks_;
    unsigned sector_bits_;
    std::vector<Block> words_;
};

}  // namespace raycache::cachesim
