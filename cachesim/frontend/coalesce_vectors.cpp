#include "cachesim/frontend/coalesce_vectors.hpp"

#include <algorithm>
#include <bit>

#include "cachesim/vector_targets.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "cachesim/frontend/coalesce_vectors.cpp"
#include <hwy/foreach_target.h>

#include "cachesim/vector_ops-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace raycache::cachesim::HWY_NAMESPACE {
namespace {

#if HWY_MAX_BYTES > 16
/// A key is a line id and, above, the low bits of the number of its access: different within a vector.
constexpr unsigned id_bits = 28;
constexpr std::uint32_t id_mask = (1u << id_bits) - 1;

constexpr std::size_t most_entries = 64;  // of one access

/// The constants of a line.
struct Shape {
    explicit Shape(const LineShape& shape)
        : line_shift(shape.line_shift),
          sector_shift(shape.sector_shift),
          sectors_shift(static_cast<int>(shape.sectors)),
          in_line(all(shape.line_bytes - 1)),
          all_sectors(all((1u << shape.sectors) - 1)) {}
    int line_shift, sector_shift, sectors_shift;
    Vector in_line, all_sectors;
};

/// A vector of lanes: keys of the lines of their first bytes, and sectors from there on; those beyond the line are the
/// first of the next. Sectors of lanes from `count` on are 0.
struct Lanes {
    Vector keys, sectors;
};
HWY_INLINE Lanes lanes_of(const std::uint32_t* elements, unsigned count, const RegionLayout& layout, std::uint32_t key,
                          const Shape& shape) {
    const Mask active = lowest(count);
    const Vector element = load_lowest(elements, count);
    if (layout.few_per_line && layout.in_line < lanes_of_vector) [[likely]] {
        const Vector sectors = permuted(load(layout.table.data()), hn::And(element, all(layout.in_line)));
        return {hn::Add(hn::ShiftRightSame(element, layout.elements_shift), all(key)),
                hn::IfThenElseZero(active, sectors)};
    }
    const Vector byte = hn::Add(hn::Mul(element, all(static_cast<std::uint32_t>(layout.stride))), all(layout.start));
    const Vector in_line = hn::And(byte, shape.in_line);
    const Vector first = hn::ShiftRightSame(in_line, shape.sector_shift);
    const Vector last =
        hn::ShiftRightSame(hn::Add(in_line, all(static_cast<std::uint32_t>(layout.extra))), shape.sector_shift);
    const Vector range = hn::Sub(hn::Shl(all(2), hn::Sub(last, first)), all(1));
    return {hn::Add(hn::ShiftRightSame(byte, shape.line_shift), all(key)),
            hn::IfThenElseZero(active, hn::Shl(range, first))};
}

/// Appends the lanes' entries, an object that straddles two lines as two; returns where the next go. Writes up to two
/// vectors more.
HWY_INLINE std::size_t append_straddling(const Lanes& lanes, const Shape& shape, std::uint32_t* keys,
                                         std::uint32_t* sectors, std::size_t end) {
    const Vector low = hn::And(lanes.sectors, shape.all_sectors),
                 high = hn::ShiftRightSame(lanes.sectors, shape.sectors_shift), next = hn::Add(lanes.keys, all(1));
    for (const unsigned half : {0u, lanes_of_vector / 2}) {
        const Vector twice = hn::Add(hn::ShiftRight<1>(places()), all(half));  // 0, 0, 1, 1, …
        const Vector s = hn::OddEven(permuted(high, twice), permuted(low, twice));
        const Mask some = in_common(s, s);
        store(keys + end, compressed(hn::OddEven(permuted(next, twice), permuted(lanes.keys, twice)), some));
        store(sectors + end, compressed(s, some));
        end += count_of(some);
    }
    return end;
}

/// Distinct keys in order of first appearance, each with the sectors of all its entries.
struct Merged {
    Vector keys, sectors;
    unsigned count;
};

#if RAYCACHE_HAS_CONFLICTS
/// Any bit of any lane.
HWY_INLINE std::uint32_t bits_of_all_lanes(Vector what) {
    return static_cast<std::uint32_t>(_mm512_reduce_or_epi32(what.raw));
}

/// Of up to a vector of entries.
template <unsigned sectors_per_line>
HWY_INLINE Merged merge(const std::uint32_t* keys, const std::uint32_t* sectors, unsigned count) {
    // Last entry first: conflicts() then tells every entry which *later* ones have its key.
    const Mask valid = lowest(count);
    const Vector reversed = hn::Sub(all(count - 1), places());
    const Vector key = permuted(load(keys), reversed),
                 wanted = hn::IfThenElseZero(valid, permuted(load(sectors), reversed));
    const Vector later = hn::IfThenElseZero(valid, conflicts(key));
    const std::uint32_t firsts = bits_of(valid) & ~bits_of_all_lanes(later);
    const Vector same = hn::Or(later, hn::Shl(all(1), places()));
    Vector merged = hn::Zero(words_tag);
    for (unsigned s = 0; s < sectors_per_line; ++s) {
        const Vector bit = all(1u << s);
        const Vector have = all(bits_of(hn::TestBit(wanted, bit)));
        merged = hn::IfThenElse(in_common(same, have), hn::Or(merged, bit), merged);
    }
    const auto distinct = static_cast<unsigned>(std::popcount(firsts));
    const Vector order = hn::Sub(all(distinct - 1), places());
    const Mask first = mask_of(firsts);
    return {permuted(compressed(key, first), order), permuted(compressed(merged, first), order), distinct};
}
#else
/// Every lane meets the others in turn.
template <unsigned by>
HWY_INLINE void meet(Vector key, Vector wanted, Vector& merged, Vector& repeated) {
    if constexpr (by < lanes_of_vector) {
        const Vector equal = hn::VecFromMask(words_tag, hn::Eq(key, rotated<by>(key)));
        merged = hn::Or(merged, hn::And(equal, rotated<by>(wanted)));
        // In lanes from here on it was an earlier lane.
        repeated = hn::Or(repeated, hn::AndNot(hn::VecFromMask(words_tag, lowest(lanes_of_vector - by)), equal));
        meet<by + 1>(key, wanted, merged, repeated);
    }
}

/// Of up to a vector of entries.
template <unsigned>
HWY_INLINE Merged merge(const std::uint32_t* keys, const std::uint32_t* sectors, unsigned count) {
    const Mask valid = lowest(count);
    const Vector key = load(keys), wanted = hn::IfThenElseZero(valid, load(sectors));
    Vector merged = wanted, repeated = hn::Zero(words_tag);
    meet<1>(key, wanted, merged, repeated);
    const Mask first = hn::AndNot(hn::MaskFromVec(repeated), valid);
    return {compressed(key, first), compressed(merged, first), count_of(first)};
}
#endif

/// Takes out of `from` the keys that `into` has, which gets their sectors.
HWY_INLINE void move_equal(Merged& from, Merged& into) {
    HWY_ALIGN std::uint32_t keys[lanes_of_vector], sectors[lanes_of_vector];
    hn::Store(from.keys, words_tag, keys);
    hn::Store(from.sectors, words_tag, sectors);
    const Mask valid = lowest(into.count);
    std::uint32_t moved = 0;
    for (unsigned i = 0; i < from.count; ++i) {
        const Mask equal = hn::And(valid, hn::Eq(into.keys, all(keys[i])));
        into.sectors = hn::Or(into.sectors, hn::IfThenElseZero(equal, all(sectors[i])));
        moved |= std::uint32_t{!hn::AllFalse(words_tag, equal)} << i;
    }
    const Mask left = hn::AndNot(mask_of(moved), lowest(from.count));
    from.keys = compressed(from.keys, left);
    from.sectors = compressed(from.sectors, left);
    from.count = count_of(left);
}

/// Adds merged entries to `out`. Of the number of the access, a key has the low bits; `access` is that of the first
/// entry, below all others by less than sixteen, when numbered from `first`.
HWY_INLINE void add(const Merged& merged, std::uint32_t access, std::uint32_t first, Lookups& out) {
    const Vector after = hn::And(hn::Sub(hn::ShiftRight<id_bits>(merged.keys), all(access)), all(~id_mask >> id_bits));
    store(&out.lines[out.count], hn::And(merged.keys, all(id_mask)));
    store(&out.sectors[out.count], merged.sectors);
    store(&out.accesses[out.count], hn::Add(after, all(first + access)));
    out.count += merged.count;
}

/// Adds what more than a vector of entries of one access become.
template <unsigned sectors_per_line>
void add_many(const std::uint32_t* keys, const std::uint32_t* sectors, unsigned count, std::uint32_t access,
              std::uint32_t first, Lookups& out) {
    Merged pieces[most_entries / lanes_of_vector];
    for (unsigned n = 0; n * lanes_of_vector < count; ++n) {
        const unsigned begin = n * lanes_of_vector;
        pieces[n] = merge<sectors_per_line>(keys + begin, sectors + begin, std::min(count - begin, lanes_of_vector));
        for (unsigned earlier = 0; earlier < n; ++earlier) move_equal(pieces[n], pieces[earlier]);
    }
    for (unsigned n = 0; n * lanes_of_vector < count; ++n) add(pieces[n], access, first, out);
}

/// Packs the accesses' lanes; returns how many vectors they are. No access is in two of them, so one with more
/// entries is a vector by itself, and longer.
std::size_t pack(std::span<const WarpAccess> accesses, const std::vector<RegionLayout>& layouts, const Shape& shape,
                 PackedLanes& packed) {
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
void add_vectors(std::size_t vectors, const PackedLanes& packed, std::uint32_t first, Lookups& out) {
    for (std::size_t v = 0; v < vectors; ++v) {
        const std::uint32_t begin = packed.begin[v], count = packed.begin[v + 1] - begin;
        const std::uint32_t *const keys = &packed.keys[begin], *const sectors = &packed.sectors[begin];
        if (count <= lanes_of_vector)
            add(merge<sectors_per_line>(keys, sectors, count), packed.accesses[v], first, out);
        else
            add_many<sectors_per_line>(keys, sectors, count, packed.accesses[v], first, out);
    }
}

void coalesce(std::span<const WarpAccess> accesses, std::uint32_t first, const std::vector<RegionLayout>& layouts,
              const LineShape& line_shape, PackedLanes& packed, Lookups& out) {
    if (accesses.empty()) return;
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

CoalesceVectors* fastest() { return coalesce; }
#else
// Few accesses fit four lanes, and Coalescer's hash table beats merging vectors of one access.
CoalesceVectors* fastest() { return nullptr; }
#endif

}  // namespace
}  // namespace raycache::cachesim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "cachesim/dispatch.hpp"

namespace raycache::cachesim {

HWY_EXPORT(fastest);

CoalesceVectors* coalesce_vectors(InstructionSet instructions) {
    return instructions == InstructionSet::scalar ? nullptr : RAYCACHE_DISPATCH(fastest, instructions)();
}

}  // namespace raycache::cachesim
#endif
