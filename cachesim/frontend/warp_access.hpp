// A warp access on its way into the front end.
#pragma once

#include <bit>
#include <cstdint>

namespace raycache::cachesim {

struct WarpAccess {
    const std::uint32_t* elements = nullptr;  ///< one index for each active lane, lowest lane first
    std::uint32_t mask = 0;                   ///< active lanes; never 0
    std::uint32_t region = 0;

    unsigned lanes() const { return static_cast<unsigned>(std::popcount(mask)); }
};

}  // namespace raycache::cachesim
