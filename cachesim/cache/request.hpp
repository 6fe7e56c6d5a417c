// What travels from the front end through the cache levels: one line of one warp access, and the sectors of it that are
// wanted.
#pragma once

#include <cstdint>

namespace raycache::cachesim {

/// One tag look-up. A level answers it by leaving only the sectors that it lacks.
struct Request {
    std::uint64_t line = 0;     ///< byte address / line size; decides the set
    std::uint32_t sectors = 0;  ///< bit s = sector s of the line; 0 only in an answer
    std::uint16_t group = 0;    ///< whom to charge (Tally)
    std::uint8_t region = 0;    ///< where the line lies: LineIds numbers it from there
    std::uint8_t cache = 0;     ///< which L1 of the SM; a level of one cache ignores it
};
static_assert(sizeof(Request) == 16);

}  // namespace raycache::cachesim
