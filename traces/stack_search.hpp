// Finds the symbol that leads to a known successor. Internal to traces/.
#pragma once

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

#include <bit>
#include <cstdint>

#include "traces/lane_stack.hpp"

namespace raycache::traces {

inline constexpr unsigned not_found = 0xff;

/// Of the eight words that end below `top`, those equal to `word`: two bits each, the highest for the topmost.
[[gnu::always_inline]] inline std::uint32_t match_top8(const std::uint32_t* top, std::uint32_t word) {
#if defined(__SSE2__)
    const __m128i wanted = _mm_set1_epi32(static_cast<int>(word));
    const __m128i high = _mm_loadu_si128(reinterpret_cast<const __m128i*>(top - 4));
    const __m128i low = _mm_loadu_si128(reinterpret_cast<const __m128i*>(top - 8));
    return static_cast<std::uint32_t>(
        _mm_movemask_epi8(_mm_packs_epi32(_mm_cmpeq_epi32(low, wanted), _mm_cmpeq_epi32(high, wanted))));
#else
    std::uint32_t bits = 0;
    for (int i = 0; i < 8; ++i) bits |= (top[i - 8] == word ? 3u : 0u) << (2 * i);
    return bits;
#endif
}

/// The depth for LaneStack::follow that yields `word`, which is no `no_link`; or `not_found`.
[[gnu::always_inline]] inline unsigned find_depth(const LaneStack& stack, const std::uint32_t* links, unsigned degree,
                                                  std::uint32_t word) {
    const std::uint32_t* top = stack.words.data() + stack.top;
    std::uint64_t bits = match_top8(top, word);
    for (unsigned i = 0; i < degree; ++i) bits |= std::uint64_t{links[i] == word} << (15 + 2 * (degree - i));
    if (bits != 0) [[likely]]
        return 7 + degree - (63 - static_cast<unsigned>(std::countl_zero(bits))) / 2;
    const std::uint32_t height = stack.top - LaneStack::floor;
    for (std::uint32_t k = 8; k < height; ++k)
        if (top[-1 - static_cast<int>(k)] == word) return degree + k;
    return not_found;
}

}  // namespace raycache::traces
