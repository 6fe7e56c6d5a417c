// Writes a warp whose symbols are not known: looks ahead for each lane's successor and searches the lane's stack for
// it. Internal to traces/.
#pragma once

#include <array>
#include <cstdint>

#include "traces/block_streams.hpp"
#include "traces/header.hpp"
#include "traces/lane_stack.hpp"
#include "traces/record.hpp"
#include "traces/schedule.hpp"
#include "traces/successors.hpp"

namespace raycache::traces {

/// Kept from warp to warp for its memory.
class SymbolSearch {
public:
    /// Throws Error if the warp breaks a rule of record.hpp.
    void write(const Header&, Schedule&, const WarpTrace&, BlockStreams&);

private:
    using NextIn = std::array<std::uint32_t, 3>;

    void write_starts(Schedule&, std::uint32_t mask, const Successor*, BlockStreams&);
    template <unsigned fixed_degree>
    [[gnu::noinline]] void write_access(const Header&, Schedule&, const Record&, const std::uint32_t*, const Successor*,
                                        const NextIn&, BlockStreams&);
    std::uint8_t spell(Schedule&, unsigned lane, std::uint32_t next_region, std::uint32_t next_element,
                       const Successor&, BlockStreams&);

    std::array<LaneStack, warp_lanes> stacks_;
    SuccessorFinder successors_;
};

}  // namespace raycache::traces
