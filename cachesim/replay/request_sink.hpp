// Who listens to a replay: every look-up of chosen caches, in the order in which the cache answers them.
//
// The order within one cache is exactly that of the replay; so is the order among the L1s of one SM. Look-ups of
// different SMs come one SM at a time: their order says nothing. Calls bring many at once: all accesses that an SM
// issued in a stretch of rounds, then what each of its levels answered for them; at the end of a window of rounds, what
// the level that all SMs share answered.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "traces/header.hpp"
#include "traces/record.hpp"

namespace raycache::cachesim {

/// One look-up: some sectors of one line, on behalf of one warp access.
struct ServedRequest {
    std::uint64_t address = 0;  ///< of the line's first byte
    std::uint32_t asked = 0;    ///< bit s = sector s of the line was asked for; never 0
    std::uint32_t missing = 0;  ///< those of `asked` that were not there
    std::uint32_t sm = 0;       ///< whose cache; 0 for the level that all share
    std::uint32_t cache = 0;    ///< which L1 of the SM; 0 for the levels below
    traces::RayType ray = {};   ///< of the warp access, as are the next three
    std::uint8_t bounce = 0;
    traces::ObjectKind kind = {};
    bool counted = true;       ///< whether it belongs to a batch of the replay's statistics
    std::uint32_t access = 0;  ///< on whose behalf: IssuedAccess::number
    std::uint32_t line = 0;    ///< number of the line, without large gaps: that of the launch's LineIds
};

/// A warp access, before its look-ups.
struct IssuedAccess {
    traces::Record record;
    const std::uint32_t* elements = nullptr;  ///< one for each active lane, lowest first; valid during the call
    std::uint32_t warp = 0;                   ///< WarpTrace::warp
    std::uint32_t number = 0;                 ///< no other of this window has it; small enough to index an array
    bool counted = true;                      ///< as ServedRequest has it
};

class RequestSink {
public:
    virtual ~RequestSink() = default;

    /// Whether to hear of the caches of Gpu::levels[level] that belong to this SM, 0 for those that all share.
    virtual bool wants(std::size_t level, std::uint32_t sm) const = 0;
    virtual void served(std::size_t level, std::span<const ServedRequest>) = 0;

    /// Every warp access comes once, on whichever SM, before its look-ups.
    virtual void issued(std::span<const IssuedAccess>) {}
    /// All look-ups of the accesses issued so far have been answered; numbers are used anew.
    virtual void end_window() {}
};

}  // namespace raycache::cachesim
