// What travels from the front end through the cache levels: one line of one warp access, and the sectors of it that are
// wanted.
#pragma once

#include <cstdint>

namespace raycache::cachesim {

/// One tag look-up. A level answers it by the same request with only the sectors that it lacks.
struct Request {
    std::uint64_t line = 0;     ///< byte address / line size; decides the set
    std::uint32_t id = 0;       ///< the same line in the dense numbering of LineIds, if that numbering fits 32 bits
    std::uint32_t sectors = 0;  ///< bit s = sector s of the line; never 0
    std::uint16_t cache = 0;    ///< which of the level's caches: the number of the L1; a shared level ignores it
    std::uint16_t group = 0;    ///< whom to charge (Tally)
};

}  // namespace raycache::cachesim
