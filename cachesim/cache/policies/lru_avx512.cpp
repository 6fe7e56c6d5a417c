#include "cachesim/cache/policies/lru_avx512.hpp"

#include <bit>
#include <vector>

#include "cachesim/avx512.hpp"

namespace raycache::cachesim {

namespace {

/// Tag and sectors share a 32-bit word; an empty way is the word 0: line 0 without sectors.
template <unsigned vectors>
class LruAvx512 final : public Level {
public:
    LruAvx512(const CacheGeometry& geometry, unsigned caches, const LineIds& ids)
        : ids_(ids),
          map_(geometry),
          fill_(geometry),
          sets_per_cache_(caches > 1 ? geometry.slices * geometry.sets : 0),
          near_(geometry.slices * geometry.sets * sizeof(Set) <= near),
          oldest_(std::uint64_t{1} << (geometry.ways - 1)),
          sector_bits_(geometry.line_bytes / geometry.sector_bytes),
          sets_(geometry.slices * geometry.sets * caches) {}

    RAYCACHE_AVX512 void process(std::span<Request> requests, std::uint32_t first_cache) override {
        Set* const first = sets_.data() + first_cache * sets_per_cache_;
        if (near_) {
            for (Request& request : requests) {
                const std::uint64_t set = request.cache * sets_per_cache_ + map_(request.line);
                request.sectors = fetch(first[set], request);
            }
            return;
        }
        std::array<Set*, 64> sets;  // a run of look-ups ahead, so that their memory is on its way
        while (!requests.empty()) {
            const auto run = requests.first(std::min(requests.size(), sets.size()));
            for (std::size_t i = 0; i < run.size(); ++i) {
                sets[i] = first + run[i].cache * sets_per_cache_ + map_(run[i].line);
                for (unsigned v = 0; v < vectors; ++v) __builtin_prefetch(&sets[i]->words[v * 16], 1);
            }
            for (std::size_t i = 0; i < run.size(); ++i) run[i].sectors = fetch(*sets[i], run[i]);
            requests = requests.subspan(run.size());
        }
    }

private:
    /// A cache of so many bytes of words stays in the L1 of the machine while its look-ups last.
    static constexpr std::size_t near = 16384;

    struct alignas(64) Set {
        std::uint32_t words[vectors * 16] = {};
    };

    /// The missing sectors and what Fill adds.
    RAYCACHE_AVX512 std::uint32_t fetch(Set& set, const Request& request) const {
        const std::uint32_t missing = access(set, request);
        if (!fill_.widens() || !missing) return missing;
        Request neighbours = request;
        neighbours.sectors = fill_.pieces(missing);
        return missing | access(set, neighbours);
    }

    RAYCACHE_AVX512 std::uint32_t access(Set& set, const Request& request) const {
        const std::uint32_t sector_mask = (1u << sector_bits_) - 1;
        const std::uint32_t tag = static_cast<std::uint32_t>(request.line - ids_.offset(request.region))
                                  << sector_bits_;
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
        __m512i before = _mm512_set1_epi32(static_cast<int>(tag | present | request.sectors));
        for (unsigned v = 0; v < vectors; ++v) {
            const auto here = static_cast<__mmask16>(moved >> (v * 16));
            const __m512i shifted = _mm512_mask_alignr_epi32(words[v], here, words[v], before, 15);
            _mm512_store_si512(&set.words[v * 16], shifted);
            before = words[v];
        }
        return request.sectors & ~present;
    }

    LineIds ids_;
    LineMap map_;
    Fill fill_;
    std::uint64_t sets_per_cache_;  ///< 0 for a shared level
    bool near_;
    std::uint64_t oldest_;  ///< bit of the oldest way
    unsigned sector_bits_;
    std::vector<Set> sets_;
};

}  // namespace

std::unique_ptr<Level> make_lru_avx512(const CacheGeometry& geometry, unsigned caches, const LineIds& ids) {
    switch ((geometry.ways + 15) / 16) {
        case 1:
            return std::make_unique<LruAvx512<1>>(geometry, caches, ids);
        case 2:
            return std::make_unique<LruAvx512<2>>(geometry, caches, ids);
        case 3:
            return std::make_unique<LruAvx512<3>>(geometry, caches, ids);
        default:
            return std::make_unique<LruAvx512<4>>(geometry, caches, ids);
    }
}

}  // namespace raycache::cachesim
