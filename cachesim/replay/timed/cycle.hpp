// Points in time of a timed replay.
#pragma once

#include <cstdint>

namespace raycache::cachesim {

/// Of the SM's clock, from the launch of the first kernel.
using Cycle = std::uint64_t;

/// Later than any other.
inline constexpr Cycle never = ~Cycle{0};

}  // namespace raycache::cachesim
