// Coalescing in vectors, as many lanes at once as they have: the same look-ups in the same order as Coalescer without.
//
// Most accesses of divergent rays have few lanes, so lanes of consecutive accesses are packed into one vector as long
// as whole accesses fit.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cachesim/cache/lookups.hpp"
#include "cachesim/frontend/region_layout.hpp"
#include "cachesim/frontend/warp_access.hpp"
#include "cachesim/instruction_set.hpp"

namespace raycache::cachesim {

/// Lanes of consecutive accesses on their way into vectors; contents are of no interest between calls.
struct PackedLanes {
    std::vector<std::uint32_t> keys, sectors;    ///< of each lane's line, or of both where its object straddles two
    std::vector<std::uint32_t> begin, accesses;  ///< of each vector: its first lane, and whose that is
};

using CoalesceVectors = void(std::span<const WarpAccess>, std::uint32_t first, const std::vector<RegionLayout>&,
                             const LineShape&, PackedLanes&, Lookups& out);

/// What adds the look-ups of accesses, numbered from `first` on. All regions must have RegionLayout::vectors. Nothing
/// for vectors of 128 bits, where Coalescer's own way is faster.
CoalesceVectors* coalesce_vectors(InstructionSet);

}  // namespace raycache::cachesim
