#include "cachesim/cache/lookups.hpp"

#include <bit>

#include "cachesim/avx512.hpp"

namespace raycache::cachesim {

namespace {

RAYCACHE_AVX512 void drop_answered_avx512(Lookups& l) {
    constexpr std::size_t lanes = 16;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < l.count; i += lanes) {
        const auto valid =
            static_cast<__mmask16>(_bzhi_u32(0xffff, static_cast<unsigned>(std::min(l.count - i, lanes))));
        const __m512i lines = _mm512_maskz_loadu_epi32(valid, &l.lines[i]),
                      sectors = _mm512_maskz_loadu_epi32(valid, &l.sectors[i]),
                      accesses = _mm512_maskz_loadu_epi32(valid, &l.accesses[i]);
        const __mmask16 fetched = _mm512_test_epi32_mask(sectors, sectors);
        const auto count = static_cast<unsigned>(std::popcount(static_cast<unsigned>(fetched)));
        const auto store = [&](std::vector<std::uint32_t>& to, __m512i what) RAYCACHE_AVX512 {
            _mm512_mask_storeu_epi32(&to[kept], valid, _mm512_maskz_compress_epi32(fetched, what));
        };
        store(l.lines, lines);
        store(l.sectors, sectors);
        store(l.accesses, accesses);
        kept += count;
    }
    l.count = kept;
}

}  // namespace

void Lookups::drop_answered(InstructionSet instructions) {
    if (instructions >= InstructionSet::avx512) {
        drop_answered_avx512(*this);
        return;
    }
    std::size_t kept = 0;
    for (std::size_t i = 0; i < count; ++i) {
        lines[kept] = lines[i];
        sectors[kept] = sectors[i];
        accesses[kept] = accesses[i];
        kept += sectors[i] != 0;
    }
    count = kept;
}

}  // namespace raycache::cachesim
