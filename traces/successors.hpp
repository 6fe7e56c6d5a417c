// For every symbol that a warp needs: where the lane goes next. Internal to traces/.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "traces/header.hpp"
#include "traces/record.hpp"

namespace raycache::traces {

/// The next access of a lane within the same ray.
struct Successor {
    std::uint32_t word = no_link;  ///< as in Region::links; both top bits set where the region cannot be linked to
    std::uint32_t region = ray_start;

    bool none() const { return region == ray_start; }
    std::uint32_t element() const { return word & 0x3fffffffu; }
};

/// Checks a warp and looks ahead in it. Kept from warp to warp for its memory.
class SuccessorFinder {
public:
    /// Throws Error if the warp breaks a rule of record.hpp.
    void find(const Header&, const WarpTrace&);

    std::vector<Successor> after;  ///< of each lane of each record, in order; a ray start has them too
    /// For each record, lanes (not only its own) whose next access, after the record, is in region 0, 1, 2.
    std::vector<std::array<std::uint32_t, 3>> next_in;
    std::array<Successor, warp_lanes> at_start;  ///< by lane: accesses that no ray start of the warp precedes
    std::uint32_t lanes_at_start = 0;            ///< those of at_start that are not none
};

}  // namespace raycache::traces
