// Front end: warp accesses -> the distinct cache lines that each touches, and of each line the distinct sectors.
//
// Every active lane reads one whole object [base + index * stride, … + element_size). Lanes that touch the same line
// share one look-up; lanes that touch the same sector share that sector. Lines come in the order in which the lanes,
// lowest first, first touch them; the lines of one object in ascending order.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "cachesim/cache/line_ids.hpp"
#include "cachesim/cache/lookups.hpp"
#include "cachesim/frontend/coalesce_vectors.hpp"
#include "cachesim/frontend/region_layout.hpp"
#include "cachesim/frontend/warp_access.hpp"
#include "cachesim/instruction_set.hpp"
#include "traces/header.hpp"

namespace raycache::cachesim {

class Coalescer {
public:
    /// `ids` must outlive this object.
    Coalescer(const std::vector<traces::Region>& regions, const LineShape& shape, LineIds& ids, InstructionSet);

    /// Adds the look-ups of each access, those of the first numbered `first`, the next first + 1, ….
    void operator()(std::span<const WarpAccess> accesses, std::uint32_t first, Lookups& out);

private:
    void add_one(const WarpAccess&, std::uint32_t number, Lookups& out);

    LineShape shape_;
    LineIds& ids_;
    CoalesceVectors* vectors_ = nullptr;  ///< where the machine has vectors, and every region can use them
    std::size_t most_lookups_ = 0;        ///< of one access
    std::vector<RegionLayout> layouts_;
    std::vector<std::uint32_t> table_;
    int table_shift_ = 0;
    std::uint32_t base_ = 0;
    PackedLanes packed_;
};

}  // namespace raycache::cachesim
