#include "cachesim/cache/policies/lru_avx512.hpp"

#include <algorithm>
#include <bit>
#include <vector>

#include "cachesim/avx512.hpp"

namespace raycache::cachesim {

namespace {

/// Tag and sectors share a 32-bit word; an empty way is the word 0: line 0 without sectors.
template <unsigned vectors>
class LruAvx512 final : public Level {
public:
    LruAvx512(const CacheGeometry& geometry, unsigned caches)
        : fill_(geometry),
          near_(geometry.slices * geometry.sets * sizeof(Set) <= near),
          oldest_(std::uint64_t{1} << (geometry.ways - 1)),
          sector_bits_(geometry.line_bytes / geometry.sector_bytes),
          sets_(geometry.slices * geometry.sets * caches) {}

    RAYCACHE_AVX512 void process(const std::uint32_t* sets, const std::uint32_t* lines, std::uint32_t* sectors,
                                 std::size_t count) override {
        if (near_) {
            for (std::size_t i = 0; i < count; ++i) sectors[i] = fetch(sets_[sets[i]], lines[i], sectors[i]);
            return;
        }
        constexpr std::size_t ahead = 32;  // so that their memory is on its way
        for (std::size_t i = 0; i < std::min(ahead, count); ++i) prefetch(sets[i]);
        for (std::size_t i = 0; i < count; ++i) {
            prefetch(sets[std::min(i + ahead, count - 1)]);
            sectors[i] = fetch(sets_[sets[i]], lines[i], sectors[i]);
        }
    }

private:
    /// A cache of so many bytes of words stays in the L1 of the machine while its look-ups last.
    static constexpr std::size_t near = 16384;

    struct alignas(64) Set {
        std::uint32_t words[vectors * 16] = {};
    };

    void prefetch(std::uint32_t set) const {
        for (unsigned v = 0; v < vectors; ++v) __builtin_prefetch(&sets_[set].words[v * 16], 1);
    }

    /// The missing sectors and what Fill adds.
    RAYCACHE_AVX512 std::uint32_t fetch(Set& set, std::uint32_t line, std::uint32_t wanted) const {
        const std::uint32_t missing = access(set, line, wanted);
        if (!fill_.widens() || !missing) return missing;
        return missing | access(set, line, fill_.pieces(missing));
    }

    RAYCACHE_AVX512 std::uint32_t access(Set& set, std::uint32_t line, std::uint32_t sectors) const {
        const std::uint32_t sector_mask = (1u << sector_bits_) - 1;
        const std::uint32_t tag = line << sector_bits_;
        const __m512i tag_mask = _mm512_set1_epi32(static_cast<int>(~sector_mask));
        const __m512i wanted = _mm512_set1_epi32(static_cast<int>(tag));
        __m512i words[vectors];
        std::uint64_t candidates = oldest_;  // if the line is in no way, it takes the oldest
        for (unsigned v = 0; v < vectors; ++v) {
            words[v] = _mm512_load_si512(&set.words[v * 16]);
            const __mmask16 equal = _mm512_testn_epi32_mask(_mm512_xor_si512(words[v], wanted), tag_mask);
            candidates |= std::uint64_t{equal} << (v * 16);
        }
        // Whether the tag is equal cannot be predicted, so it becomes a mask: only 0 - 1 is negative.
        const std::uint32_t difference = set.words[std::countr_zero(candidates)] ^ tag;
        const auto equal = static_cast<std::int32_t>((difference >> sector_bits_) - 1) >> 31;
        const std::uint32_t present = difference & static_cast<std::uint32_t>(equal);
        const std::uint64_t moved = candidates ^ (candidates - 1);  // this way and all newer ones
        __m512i before = _mm512_set1_epi32(static_cast<int>(tag | present | sectors));
        for (unsigned v = 0; v < vectors; ++v) {
            const auto here = static_cast<__mmask16>(moved >> (v * 16));
            const __m512i shifted = _mm512_mask_alignr_epi32(words[v], here, words[v], before, 15);
            _mm512_store_si512(&set.words[v * 16], shifted);
            before = words[v];
        }
        return sectors & ~present;
    }

    Fill fill_;
    bool near_;
    std::uint64_t oldest_;  ///< bit of the oldest way
    unsigned sector_bits_;
    std::vector<Set> sets_;
};

}  // namespace

std::unique_ptr<Level> make_lru_avx512(const CacheGeometry& geometry, unsigned caches) {
    switch ((geometry.ways + 15) / 16) {
        case 1:
            return std::make_unique<LruAvx512<1>>(geometry, caches);
        case 2:
            return std::make_unique<LruAvx512<2>>(geometry, caches);
        case 3:
            return std::make_unique<LruAvx512<3>>(geometry, caches);
        default:
            return std::make_unique<LruAvx512<4>>(geometry, caches);
    }
}

}  // namespace raycache::cachesim
