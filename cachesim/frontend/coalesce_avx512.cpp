#include "cachesim/frontend/coalesce_avx512.hpp"

#include <bit>
#include <cstring>

#include "cachesim/avx512.hpp"

namespace raycache::cachesim {

namespace {

RAYCACHE_AVX512 __m512i all(std::uint32_t value) { return _mm512_set1_epi32(static_cast<int>(value)); }

/// Line numbers (from `first_line`) and sectors of 8 requests, as requests.
RAYCACHE_AVX512 void store(__m256i lines, __m256i sectors, std::uint64_t first_line, std::uint64_t tail, Request* out) {
    const __m512i line =
        _mm512_add_epi64(_mm512_cvtepu32_epi64(lines), _mm512_set1_epi64(static_cast<long long>(first_line)));
    const __m512i rest =
        _mm512_or_si512(_mm512_cvtepu32_epi64(sectors), _mm512_set1_epi64(static_cast<long long>(tail)));
    const __m512i low = _mm512_setr_epi64(0, 8, 1, 9, 2, 10, 3, 11),
                  high = _mm512_setr_epi64(4, 12, 5, 13, 6, 14, 7, 15);
    _mm512_storeu_si512(out, _mm512_permutex2var_epi64(line, low, rest));
    _mm512_storeu_si512(out + 4, _mm512_permutex2var_epi64(line, high, rest));
}

}  // namespace

RAYCACHE_AVX512 Coalesced coalesce_avx512(const RegionLayout& layout, const LineShape& shape,
                                          const std::uint32_t* elements, unsigned lanes, const Request& like,
                                          Request* out) {
    const __m512i places = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
    // Every lane has one entry, or two where elements straddle lines: the part in the first line and the part in the
    // next. Last entry first: vpconflictd then tells every entry which *later* ones are on the same line.
    const unsigned part_bits = layout.aligned ? 0 : 1, entries = lanes << part_bits;
    const __m512i entry = _mm512_sub_epi32(all(entries - 1), places);
    const __m512i lane = _mm512_srl_epi32(entry, _mm_cvtsi32_si128(static_cast<int>(part_bits)));
    const __mmask16 second = layout.aligned ? __mmask16{0} : _mm512_test_epi32_mask(entry, all(1));
    const __m512i element =
        _mm512_permutexvar_epi32(lane, _mm512_maskz_loadu_epi32(static_cast<__mmask16>((1u << lanes) - 1), elements));

    const __m512i byte = _mm512_add_epi32(_mm512_mullo_epi32(element, all(static_cast<std::uint32_t>(layout.stride))),
                                          all(layout.start));
    const __m512i in_line = _mm512_and_si512(byte, all(shape.line_bytes - 1));
    const __m128i line_shift = _mm_cvtsi32_si128(shape.line_shift),
                  sector_shift = _mm_cvtsi32_si128(shape.sector_shift);
    const __m512i first = _mm512_srl_epi32(in_line, sector_shift);
    const __m512i last =
        _mm512_srl_epi32(_mm512_add_epi32(in_line, all(static_cast<std::uint32_t>(layout.extra))), sector_shift);
    const __m512i range =
        _mm512_sllv_epi32(_mm512_sub_epi32(_mm512_sllv_epi32(all(2), _mm512_sub_epi32(last, first)), all(1)), first);
    const __m512i sectors = _mm512_and_si512(
        _mm512_srlv_epi32(range, _mm512_maskz_mov_epi32(second, all(shape.sectors))), all((1u << shape.sectors) - 1));
    const __m512i lines = _mm512_srl_epi32(byte, line_shift);
    const __m512i line = _mm512_mask_add_epi32(lines, second, lines, all(1));
    const auto valid = static_cast<__mmask16>(_mm512_test_epi32_mask(sectors, sectors) & ((1u << entries) - 1));

    const __m512i later = _mm512_maskz_and_epi32(valid, _mm512_conflict_epi32(line), all(valid));
    const auto firsts = static_cast<__mmask16>(valid & ~static_cast<unsigned>(_mm512_reduce_or_epi32(later)));
    const __m512i same = _mm512_or_si512(later, _mm512_sllv_epi32(all(1), places));
    __m512i merged = _mm512_setzero_si512();
    Coalesced result;
    for (unsigned s = 0; s < shape.sectors; ++s) {
        const __m512i bit = all(1u << s);
        const __mmask16 have = _mm512_mask_test_epi32_mask(valid, sectors, bit);
        const __mmask16 get = _mm512_mask_test_epi32_mask(firsts, same, all(have));
        merged = _mm512_mask_or_epi32(merged, get, merged, bit);
        result.sectors += static_cast<unsigned>(std::popcount(static_cast<unsigned>(get)));
    }
    result.requests = static_cast<std::size_t>(std::popcount(static_cast<unsigned>(firsts)));

    const __m512i order = _mm512_sub_epi32(all(static_cast<std::uint32_t>(result.requests) - 1), places);
    const __m512i out_lines = _mm512_permutexvar_epi32(order, _mm512_maskz_compress_epi32(firsts, line));
    const __m512i out_sectors = _mm512_permutexvar_epi32(order, _mm512_maskz_compress_epi32(firsts, merged));
    std::uint64_t tail = 0;  // group and region, as they stand behind the line
    static_assert(offsetof(Request, sectors) == 8);
    std::memcpy(&tail, reinterpret_cast<const unsigned char*>(&like) + 8, 8);
    tail &= ~std::uint64_t{0xffffffff};
    store(_mm512_castsi512_si256(out_lines), _mm512_castsi512_si256(out_sectors), layout.first_line, tail, out);
    store(_mm512_extracti64x4_epi64(out_lines, 1), _mm512_extracti64x4_epi64(out_sectors, 1), layout.first_line, tail,
          out + 8);
    return result;
}

}  // namespace raycache::cachesim
