// Who listens to a replay: every look-up of chosen caches, in the order in which the cache answers them.
//
// The order within one cache is exactly that of the replay; so is the order among the L1s of one SM. Look-ups of
// different SMs come in batches, an SM at a time: their order says nothing.
#pragma once

#include <cstddef>
#include <cstdint>

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
    traces::RayType ray = {};   ///< of the warp access, as are the next two
    std::uint8_t bounce = 0;
    traces::ObjectKind kind = {};
    std::uint32_t access = 0;  ///< on whose behalf: how many IssuedAccess came before it in this window
};

/// A warp access, before its look-ups.
struct IssuedAccess {
    const traces::Record& record;
    const std::uint32_t* elements;  ///< one for each active lane, lowest first; valid during the call
    std::uint32_t warp = 0;         ///< WarpTrace::warp
};

class RequestSink {
public:
    virtual ~RequestSink() = default;

    /// Whether to hear of the caches of Gpu::levels[level] that belong to this SM, 0 for those that all share.
    virtual bool wants(std::size_t level, std::uint32_t sm) const = 0;
    virtual void served(std::size_t level, const ServedRequest&) = 0;

    /// Comes once for every warp access, on whichever SM, before its look-ups.
    virtual void issued(const IssuedAccess&) {}
    /// All look-ups of the accesses issued so far have been answered; the next access is number 0.
    virtual void end_window() {}
};

}  // namespace raycache::cachesim
