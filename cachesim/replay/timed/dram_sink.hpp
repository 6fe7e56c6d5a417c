// Who listens to what a timed replay asks of DRAM, in cycles of the SM clock.
#pragma once

#include <cstdint>

#include "cachesim/replay/timed/cycle.hpp"

namespace raycache::cachesim {

class DramSink {
public:
    virtual ~DramSink() = default;

    /// A sector that the last level of caches asks for in this cycle; `address`: of its first byte.
    virtual void read(std::uint64_t address, Cycle) = 0;
    /// One that a warp of a wavefront writes; in the cycle in which its CTA becomes resident (streamed_traffic.hpp).
    virtual void write(std::uint64_t address, Cycle) = 0;
    /// Sectors that a sort moves: without addresses and times.
    virtual void moved(std::uint64_t sectors) = 0;
    /// Nothing comes from now on for a cycle before this one.
    virtual void reached(Cycle) = 0;
};

}  // namespace raycache::cachesim
