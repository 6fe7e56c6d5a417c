// What the vector code of the replay needs and Highway 1.0.3 lacks. Included once for each instruction set, after
// hwy/foreach_target.h; all vectors are of 32-bit words, as long as the machine has them.
#if defined(RAYCACHE_VECTOR_OPS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYCACHE_VECTOR_OPS_INL
#undef RAYCACHE_VECTOR_OPS_INL
#else
#define RAYCACHE_VECTOR_OPS_INL
#endif

#include <hwy/highway.h>

#include <cstdint>
#include <type_traits>

/// Whether conflicts() is one instruction.
#undef RAYCACHE_HAS_CONFLICTS
#define RAYCACHE_HAS_CONFLICTS (HWY_ARCH_X86 && HWY_TARGET <= HWY_AVX3)

HWY_BEFORE_NAMESPACE();
namespace raycache::cachesim::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Words = hn::ScalableTag<std::uint32_t>;
using Vector = hn::Vec<Words>;
using Mask = hn::Mask<Words>;
constexpr Words words_tag{};
constexpr unsigned lanes_of_vector = hn::MaxLanes(words_tag);

HWY_INLINE Vector all(std::uint32_t value) { return hn::Set(words_tag, value); }
HWY_INLINE Vector load(const std::uint32_t* from) { return hn::LoadU(words_tag, from); }
HWY_INLINE void store(std::uint32_t* to, Vector what) { hn::StoreU(what, words_tag, to); }
/// 0, 1, 2, …
HWY_INLINE Vector places() { return hn::Iota(words_tag, 0); }
/// The lanes below `count`.
HWY_INLINE Mask lowest(unsigned count) { return hn::FirstN(words_tag, count); }
/// Lane i of the result is lane order[i] modulo the number of lanes.
HWY_INLINE Vector permuted(Vector what, Vector order) {
    const Vector within = hn::And(order, all(lanes_of_vector - 1));  // Highway takes no others
    return hn::TableLookupLanes(what, hn::IndicesFromVec(words_tag, within));
}

/// As many bits as lanes, or more.
using MaskBits = std::conditional_t<(lanes_of_vector > 8), std::uint16_t, std::uint8_t>;

/// Bit i: lane i.
HWY_INLINE std::uint32_t bits_of(Mask mask) {
    MaskBits bits = 0;
    hn::StoreMaskBits(words_tag, mask, reinterpret_cast<std::uint8_t*>(&bits));
    return bits;
}
/// The lanes whose bits are set.
HWY_INLINE Mask mask_of(std::uint32_t bits) {
    const auto all_bits = static_cast<MaskBits>(bits);
    return hn::LoadMaskBits(words_tag, reinterpret_cast<const std::uint8_t*>(&all_bits));
}

/// The lanes that have a bit in common.
HWY_INLINE Mask in_common(Vector a, Vector b) {
#if HWY_MAX_BYTES == 64
    return Mask{_mm512_test_epi32_mask(a.raw, b.raw)};  // g++ 12 does not make one instruction of the two below
#else
    return hn::Ne(hn::And(a, b), hn::Zero(words_tag));
#endif
}

HWY_INLINE unsigned count_of(Mask mask) { return static_cast<unsigned>(hn::CountTrue(words_tag, mask)); }

#if HWY_MAX_BYTES < 64
/// For every mask, the lanes that it has, then the others.
struct LaneOrders {
    static constexpr unsigned bytes_of_lane = HWY_MAX_BYTES == 16 ? 4 : 1;  ///< of the bytes, or of the lane
    alignas(16) std::uint8_t order[1u << lanes_of_vector][lanes_of_vector * bytes_of_lane];
};
constexpr LaneOrders make_lane_orders() {
    LaneOrders orders{};
    for (unsigned mask = 0; mask < 1u << lanes_of_vector; ++mask) {
        unsigned at = 0;
        for (const unsigned has : {1u, 0u})
            for (unsigned lane = 0; lane < lanes_of_vector; ++lane)
                if ((mask >> lane & 1) == has)
                    for (unsigned byte = 0; byte < LaneOrders::bytes_of_lane; ++byte)
                        orders.order[mask][at++] = static_cast<std::uint8_t>(lane * LaneOrders::bytes_of_lane + byte);
    }
    return orders;
}
constexpr LaneOrders lane_orders = make_lane_orders();
#endif

/// The lanes of the mask move to the front, in their order. As Highway's Compress, whose tables g++ 12 copies to the
/// stack at each call where there is no instruction for it.
HWY_INLINE Vector compressed(Vector what, Mask mask) {
#if HWY_MAX_BYTES == 64
    return hn::Compress(what, mask);
#else
    const std::uint8_t* const order = lane_orders.order[bits_of(mask)];
#if HWY_MAX_BYTES == 16
    const hn::Repartition<std::uint8_t, Words> bytes_tag;
    return hn::BitCast(words_tag, hn::TableLookupBytes(hn::BitCast(bytes_tag, what), hn::Load(bytes_tag, order)));
#else
    return permuted(what, hn::PromoteTo(words_tag, hn::LoadU(hn::Rebind<std::uint8_t, Words>(), order)));
#endif
#endif
}

/// The first `count` words, at most a vector; the other lanes 0. Reads no others.
HWY_INLINE Vector load_lowest(const std::uint32_t* from, unsigned count) {
#if HWY_MEM_OPS_MIGHT_FAULT
    if (count >= lanes_of_vector) return load(from);
    alignas(HWY_MAX_BYTES) std::uint32_t words[lanes_of_vector] = {};
    for (unsigned i = 0; i < count; ++i) words[i] = from[i];
    return hn::Load(words_tag, words);
#else
    return hn::MaskedLoad(lowest(count), words_tag, from);
#endif
}

/// Lane i has lane i - 1 of `what`, lane 0 the last of `before`.
HWY_INLINE Vector moved_up(Vector what, Vector before) {
#if HWY_MAX_BYTES == 64
    return Vector{_mm512_alignr_epi32(what.raw, before.raw, 15)};
#elif HWY_MAX_BYTES == 32
    return hn::CombineShiftRightBytes<12>(words_tag, what, hn::ConcatLowerUpper(words_tag, what, before));
#else
    return hn::CombineShiftRightBytes<12>(words_tag, what, before);
#endif
}

/// Lane i + 1 of `what` to lane i, the first to the last, `by` times.
template <unsigned by>
HWY_INLINE Vector rotated(Vector what) {
#if HWY_MAX_BYTES == 16
    return hn::CombineShiftRightBytes<4 * by>(words_tag, what, what);
#else
    return permuted(what, hn::And(hn::Add(places(), all(by)), all(lanes_of_vector - 1)));
#endif
}

#if RAYCACHE_HAS_CONFLICTS
/// Bit j of lane i: lane j < i is equal. Highway has no such operation, and its compiler options leave out AVX-512 CD.
HWY_INLINE Vector conflicts(Vector what) {
    Vector found;
    asm("vpconflictd %1, %0" : "=v"(found.raw) : "v"(what.raw));
    return found;
}
#endif

}  // namespace raycache::cachesim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
