#include "cachesim/frontend/coalesce_avx512.hpp"

#include <algorithm>
#include <bit>

#include "cachesim/avx512.hpp"

namespace raycache::cachesim {

namespace {

constexpr unsigned lanes_of_vector = 16;
/// A key is a line id and, above, the low bits of the number of its access: different within a vector.
constexpr unsigned id_bits = 28;
constexpr std::uint32_t id_mask = (1u << id_bits) - 1;

RAYCACHE_AVX512 inline __m512i all(std::uint32_t value) { return _mm512_set1_epi32(static_cast<int>(value)); }
RAYCACHE_AVX512 inline __m512i load(const std::uint32_t* from) { return _mm512_loadu_si512(from); }
RAYCACHE_AVX512 inline void store(std::uint32_t* to, __m512i what) { _mm512_storeu_si512(to, what); }
RAYCACHE_AVX512 inline __m512i places() {
    return _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
}
RAYCACHE_AVX512 inline __mmask16 lowest(unsigned count) { return static_cast<__mmask16>(_bzhi_u32(0xffff, count)); }

/// The constants of a line.
struct Shape {
    RAYCACHE_AVX512 explicit Shape(const LineShape& shape)
        : line_shift(_mm_cvtsi32_si128(shape.line_shift)),
          sector_shift(_mm_cvtsi32_si128(shape.sector_shift)),
          sectors_shift(_mm_cvtsi32_si128(static_cast<int>(shape.sectors))),
          in_line(all(shape.line_bytes - 1)),
          all_sectors(all((1u << shape.sectors) - 1)) {}
    __m128i line_shift, sector_shift, sectors_shift;
    __m512i in_line, all_sectors;
};

/// Up to sixteen lanes: keys of the lines of their first bytes, and sectors from there on; those beyond the line are
/// the first of the next. Sectors of other lanes are 0.
struct Lanes {
    __m512i keys, sectors;
};
RAYCACHE_AVX512 inline Lanes lanes_of(const std::uint32_t* elements, unsigned count, const RegionLayout& layout,
                                      std::uint32_t key, const Shape& shape) {
    const __mmask16 active = lowest(count);
    const __m512i element = _mm512_maskz_loadu_epi32(active, elements);
    if (layout.few_per_line) [[likely]] {
        const __m128i shift = _mm_cvtsi32_si128(layout.elements_shift);
        return {_mm512_add_epi32(_mm512_srl_epi32(element, shift), all(key)),
                _mm512_maskz_permutexvar_epi32(active, _mm512_and_si512(element, all(layout.in_line)),
                                               load(layout.table.data()))};
    }
    const __m512i byte = _mm512_add_epi32(_mm512_mullo_epi32(element, all(static_cast<std::uint32_t>(layout.stride))),
                                          all(layout.start));
    const __m512i in_line = _mm512_and_si512(byte, shape.in_line);
    const __m512i first = _mm512_srl_epi32(in_line, shape.sector_shift);
    const __m512i last =
        _mm512_srl_epi32(_mm512_add_epi32(in_line, all(static_cast<std::uint32_t>(layout.extra))), shape.sector_shift);
    const __m512i range = _mm512_sub_epi32(_mm512_sllv_epi32(all(2), _mm512_sub_epi32(last, first)), all(1));
    return {_mm512_add_epi32(_mm512_srl_epi32(byte, shape.line_shift), all(key)),
            _mm512_maskz_sllv_epi32(active, range, first)};
}

/// Appends the lanes' entries, an object that straddles two lines as two; returns where the next go. Writes up to two
/// vectors more.
RAYCACHE_AVX512 inline std::size_t append_straddling(const Lanes& lanes, const Shape& shape, std::uint32_t* keys,
                                                     std::uint32_t* sectors, std::size_t end) {
    const __m512i low = _mm512_and_si512(lanes.sectors, shape.all_sectors),
                  high = _mm512_srl_epi32(lanes.sectors, shape.sectors_shift),
                  next = _mm512_add_epi32(lanes.keys, all(1));
    const __m512i front = _mm512_setr_epi32(0, 16, 1, 17, 2, 18, 3, 19, 4, 20, 5, 21, 6, 22, 7, 23),
                  back = _mm512_add_epi32(front, all(8));
    for (const __m512i& half : {front, back}) {
        const __m512i s = _mm512_permutex2var_epi32(low, half, high);
        const __mmask16 some = _mm512_test_epi32_mask(s, s);
        store(keys + end, _mm512_maskz_compress_epi32(some, _mm512_permutex2var_epi32(lanes.keys, half, next)));
        store(sectors + end, _mm512_maskz_compress_epi32(some, s));
        end += static_cast<unsigned>(std::popcount(static_cast<unsigned>(some)));
    }
    return end;
}

/// Distinct keys in order of first appearance, each with the sectors of all its entries.
struct Merged {
    __m512i keys, sectors;
    unsigned count;
};

/// Of up to sixteen entries.
template <unsigned sectors_per_line>
RAYCACHE_AVX512 inline Merged merge(const std::uint32_t* keys, const std::uint32_t* sectors, unsigned count) {
    // Last entry first: vpconflictd then tells every entry which *later* ones have its key.
    const __mmask16 valid = lowest(count);
    const __m512i reversed = _mm512_sub_epi32(all(count - 1), places());
    const __m512i key = _mm512_permutexvar_epi32(reversed, load(keys)),
                  wanted = _mm512_permutexvar_epi32(reversed, load(sectors));
    const __m512i later = _mm512_maskz_mov_epi32(valid, _mm512_conflict_epi32(key));
    const auto firsts = static_cast<__mmask16>(valid & ~static_cast<unsigned>(_mm512_reduce_or_epi32(later)));
    const __m512i same = _mm512_or_si512(later, _mm512_sllv_epi32(all(1), places()));
    __m512i merged = _mm512_setzero_si512();
    for (unsigned s = 0; s < sectors_per_line; ++s) {
        const __m512i bit = all(1u << s);
        const __mmask16 have = _mm512_mask_test_epi32_mask(valid, wanted, bit);
        merged = _mm512_mask_or_epi32(merged, _mm512_mask_test_epi32_mask(firsts, same, all(have)), merged, bit);
    }
    const auto distinct = static_cast<unsigned>(std::popcount(static_cast<unsigned>(firsts)));
    const __m512i order = _mm512_sub_epi32(all(distinct - 1), places());
    return {_mm512_permutexvar_epi32(order, _mm512_maskz_compress_epi32(firsts, key)),
            _mm512_permutexvar_epi32(order, _mm512_maskz_compress_epi32(firsts, merged)), distinct};
}

/// Takes out of `from` the keys that `into` has, which gets their sectors.
RAYCACHE_AVX512 inline void move_equal(Merged& from, Merged& into) {
    alignas(64) std::uint32_t keys[lanes_of_vector], sectors[lanes_of_vector];
    _mm512_store_si512(keys, from.keys);
    _mm512_store_si512(sectors, from.sectors);
    const __mmask16 valid = lowest(into.count);
    std::uint32_t moved = 0;
    for (unsigned i = 0; i < from.count; ++i) {
        const __mmask16 equal = _mm512_mask_cmpeq_epi32_mask(valid, into.keys, all(keys[i]));
        into.sectors = _mm512_mask_or_epi32(into.sectors, equal, into.sectors, all(sectors[i]));
        moved |= std::uint32_t{equal != 0} << i;
    }
    const auto left = static_cast<__mmask16>(lowest(from.count) & ~moved);
    from.keys = _mm512_maskz_compress_epi32(left, from.keys);
    from.sectors = _mm512_maskz_compress_epi32(left, from.sectors);
    from.count = static_cast<unsigned>(std::popcount(static_cast<unsigned>(left)));
}

/// Adds merged entries to `out`. Of the number of the access, a key has the low bits; `access` is that of the first
/// entry, below all others by less than sixteen, when numbered from `first`.
RAYCACHE_AVX512 inline void add(const Merged& merged, std::uint32_t access, std::uint32_t first, Lookups& out) {
    const __m512i after = _mm512_and_si512(_mm512_sub_epi32(_mm512_srli_epi32(merged.keys, id_bits), all(access)),
                                           all(~id_mask >> id_bits));
    store(&out.lines[out.count], _mm512_and_si512(merged.keys, all(id_mask)));
    store(&out.sectors[out.count], merged.sectors);
    store(&out.accesses[out.count], _mm512_add_epi32(after, all(first + access)));
    out.count += merged.count;
}

/// Adds what more than sixteen and at most 64 entries of one access become.
template <unsigned sectors_per_line>
RAYCACHE_AVX512 void add_many(const std::uint32_t* keys, const std::uint32_t* sectors, unsigned count,
                              std::uint32_t access, std::uint32_t first, Lookups& out) {
    Merged pieces[4];
    for (unsigned n = 0; n * lanes_of_vector < count; ++n) {
        const unsigned begin = n * lanes_of_vector;
        pieces[n] = merge<sectors_per_line>(keys + begin, sectors + begin, std::min(count - begin, lanes_of_vector));
        for (unsigned earlier = 0; earlier < n; ++earlier) move_equal(pieces[n], pieces[earlier]);
    }
    for (unsigned n = 0; n * lanes_of_vector < count; ++n) add(pieces[n], access, first, out);
}

/// Packs the accesses' lanes; returns how many vectors they are. No access is in two of them, so one with more than
/// sixteen entries is a vector by itself, and longer.
RAYCACHE_AVX512 std::size_t pack(std::span<const WarpAccess> accesses, const std::vector<RegionLayout>& layouts,
                                 const Shape& shape, PackedLanes& packed) {
    constexpr std::size_t ahead = 8;
    std::uint32_t* const keys = packed.keys.data();
    std::uint32_t* const sectors = packed.sectors.data();
    std::size_t end = 0, vectors = 1, vector_begin = 0;
    packed.begin[0] = packed.accesses[0] = 0;
    for (std::size_t i = 0; i < accesses.size(); ++i) {
        const WarpAccess& access = accesses[i];
        const std::uint32_t* const later = accesses[std::min(i + ahead, accesses.size() - 1)].elements;
        __builtin_prefetch(later);
        __builtin_prefetch(later + 15);
        const RegionLayout& layout = layouts[access.region];
        const std::uint32_t key = layout.first_id + (static_cast<std::uint32_t>(i) << id_bits);
        const std::size_t begin = end;
        const std::uint32_t* elements = access.elements;
        for (unsigned left = access.lanes();;) {
            const unsigned count = std::min(left, lanes_of_vector);
            const Lanes lanes = lanes_of(elements, count, layout, key, shape);
            if (layout.aligned) {
                store(keys + end, lanes.keys);
                store(sectors + end, lanes.sectors);
                end += count;
            } else {
                end = append_straddling(lanes, shape, keys, sectors, end);
            }
            if (left <= lanes_of_vector) break;
            left -= lanes_of_vector;
            elements += lanes_of_vector;
        }
        // Begins a vector where this access no longer fits; not a branch, which could not be predicted.
        packed.begin[vectors] = static_cast<std::uint32_t>(begin);
        packed.accesses[vectors] = static_cast<std::uint32_t>(i);
        const bool full = end - vector_begin > lanes_of_vector;
        vectors += full;
        vector_begin = full ? begin : vector_begin;
    }
    packed.begin[vectors] = static_cast<std::uint32_t>(end);
    return vectors;
}

template <unsigned sectors_per_line>
RAYCACHE_AVX512 void add_vectors(std::size_t vectors, const PackedLanes& packed, std::uint32_t first, Lookups& out) {
    for (std::size_t v = 0; v < vectors; ++v) {
        const std::uint32_t begin = packed.begin[v], count = packed.begin[v + 1] - begin;
        const std::uint32_t *const keys = &packed.keys[begin], *const sectors = &packed.sectors[begin];
        if (count <= lanes_of_vector)
            add(merge<sectors_per_line>(keys, sectors, count), packed.accesses[v], first, out);
        else
            add_many<sectors_per_line>(keys, sectors, count, packed.accesses[v], first, out);
    }
}

}  // namespace

RAYCACHE_AVX512 void coalesce_avx512(std::span<const WarpAccess> accesses, std::uint32_t first,
                                     const std::vector<RegionLayout>& layouts, const LineShape& line_shape,
                                     PackedLanes& packed, Lookups& out) {
    if (accesses.empty()) return;
    constexpr std::size_t most_entries = 64;  // of one access
    if (packed.begin.size() < accesses.size() + 2) {
        packed.begin.resize(accesses.size() + 2);
        packed.accesses.resize(accesses.size() + 2);
        packed.keys.resize((accesses.size() + 1) * most_entries);
        packed.sectors.resize((accesses.size() + 1) * most_entries);
    }
    const std::size_t vectors = pack(accesses, layouts, Shape(line_shape), packed);
    out.reserve(packed.begin[vectors] + most_entries);
    if (line_shape.sectors <= 4)
        add_vectors<4>(vectors, packed, first, out);
    else
        add_vectors<8>(vectors, packed, first, out);
}

}  // namespace raycache::cachesim
