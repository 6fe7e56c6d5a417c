#include "cachesim/cache/set_finder.hpp"

#include <algorithm>

#include "cachesim/avx512.hpp"

namespace raycache::cachesim {

namespace {

RAYCACHE_AVX512 inline __m512i all(std::uint32_t value) { return _mm512_set1_epi32(static_cast<int>(value)); }

}  // namespace

SetFinder::SetFinder(const CacheGeometry& geometry, const LineIds& ids, InstructionSet instructions)
    : map_(geometry, ids.last_line()),
      ids_(ids),
      sets_per_cache_(static_cast<std::uint32_t>(geometry.slices * geometry.sets)) {
    if (!ids.dense()) return;
    if (map_.is_low_bits() && geometry.sets <= 1u << LineIds::equal_bits) form_ = Form::low_bits;
    constexpr std::size_t most_runs = 8;
    if (map_.tables().empty() || instructions < InstructionSet::avx512 || ids.runs().size() > most_runs) return;
    const auto& runs = ids.runs();
    for (std::size_t i = 0; i < runs.size(); ++i) {
        const std::uint64_t end = i + 1 < runs.size() ? runs[i + 1].first : ids.bound();
        const std::uint64_t first = runs[i].first + runs[i].offset, last = end - 1 + runs[i].offset;
        if (first >> 32 != last >> 32) return;  // half of a line must do
        runs_.push_back({runs[i].first, static_cast<std::uint32_t>(runs[i].offset),
                         static_cast<std::uint32_t>(map_(first >> 32 << 32))});
    }
    form_ = Form::tables;
}

RAYCACHE_AVX512 void SetFinder::find_by_tables(const Lookups& lookups, std::uint32_t* sets) const {
    constexpr std::size_t lanes = 16;
    const auto& tables = map_.tables();
    const std::size_t bytes = std::min<std::size_t>(tables.size(), 4);
    for (std::size_t i = 0; i < lookups.count; i += lanes) {
        const auto count = static_cast<unsigned>(std::min(lookups.count - i, lanes));
        const __m512i id =
            _mm512_maskz_loadu_epi32(static_cast<__mmask16>(_bzhi_u32(0xffff, count)), &lookups.lines[i]);
        __m512i offset = all(runs_[0].offset), set = all(runs_[0].high);
        for (std::size_t run = 1; run < runs_.size(); ++run) {
            const __mmask16 in = _mm512_cmpge_epu32_mask(id, all(runs_[run].first));
            offset = _mm512_mask_mov_epi32(offset, in, all(runs_[run].offset));
            set = _mm512_mask_mov_epi32(set, in, all(runs_[run].high));
        }
        __m512i line = _mm512_add_epi32(id, offset);
        for (std::size_t byte = 0; byte < bytes; ++byte) {
            set = _mm512_xor_si512(
                set, _mm512_i32gather_epi32(_mm512_and_si512(line, all(0xff)), tables[byte].data(), sizeof(int)));
            line = _mm512_srli_epi32(line, 8);
        }
        _mm512_storeu_si512(&sets[i], set);
    }
}

}  // namespace raycache::cachesim
