// What load and store instructions of a warp read and write, as an import hands it on.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "traces/record.hpp"

namespace raycache::traces {

/// One warp access: each active lane reads one object, or writes one. Or, with an empty mask, the end of a warp.
struct LoadAccess {
    std::uint32_t mask = 0;   ///< active lanes
    std::uint32_t bytes = 0;  ///< of an object, 1 to 4096
    bool is_store = false;
    std::uint32_t grain = 1;  ///< a power of two up to 32 that divides every address of objects of this kind
    std::array<std::uint64_t, warp_lanes> addresses{};  ///< of the active lanes, lowest lane first
    std::vector<IssueStep> steps = {};  ///< before it, where they are known; IssueStep::access is not set

    unsigned lanes() const { return static_cast<unsigned>(std::popcount(mask)); }
};

}  // namespace raycache::traces
