// What a lane may read next: the links it saw and did not take. Shared by encoder and decoder, so that both always hold
// the same stacks. Internal to traces/.
//
// A word is (region << 30) | element with region 0 … 2, as in Region::links. Words with both top bits set are no
// element that can be linked to; `no_link` is one of them.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "traces/format.hpp"
#include "traces/header.hpp"

namespace raycache::traces {

inline constexpr unsigned element_bits = 30;
inline constexpr std::uint32_t element_mask = (1u << element_bits) - 1;
inline constexpr std::uint32_t unlinkable = 3;                        ///< top bits of a word that no link can hold
inline constexpr std::uint32_t no_word = unlinkable << element_bits;  ///< the first such word

struct LaneStack {
    /// Below the stack stand as many `no_link` words as a symbol can reach down: no check on the way is needed.
    static constexpr unsigned floor = 128;

    std::array<std::uint32_t, floor + format::stack_entries + format::max_degree> words;
    std::uint32_t top = floor;

    LaneStack() { words.fill(no_link); }
    void clear() { top = floor; }

    /// Carries out symbol `depth` (0 … 127) after an access to an element with these links, and returns the successor:
    /// depth < degree takes that link and pushes the others, the first one topmost; any other depth pops
    /// depth - degree + 1 words and takes the last of them. The result is `no_link` if there is no such word.
    [[gnu::always_inline]] std::uint32_t follow(const std::uint32_t* links, unsigned degree, unsigned depth) {
        const std::uint32_t below = top + degree - 1 - depth;  // a word of the array even where it is not used
        const std::uint32_t popped = words[below];
        if (degree == 0) return top = below, popped;
        const std::uint32_t pop = 0u - std::uint32_t{depth >= degree};  // all ones or none: no branch to mispredict
        std::uint32_t taken, pushed = top;
        if (degree == 2) {
            const std::uint32_t other = links[~depth & 1];
            taken = links[depth & 1];
            words[top] = other;
            pushed += other != no_link;
        } else {
            taken = links[std::min(depth, degree - 1)];
            for (unsigned i = degree; i-- > 0;) {
                words[pushed] = links[i];
                pushed += (i != depth) & (links[i] != no_link);
            }
        }
        pushed = std::min(pushed, floor + format::stack_entries);
        top = pushed ^ ((pushed ^ below) & pop);
        return taken ^ ((taken ^ popped) & pop);
    }
};

}  // namespace raycache::traces
