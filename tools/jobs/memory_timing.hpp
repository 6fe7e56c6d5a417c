// How long this processor takes to reach and to read memory: pointer chases and streams on the calling thread.
#pragma once

#include <cstdint>
#include <vector>

namespace raycache::tools {

/// Clock of this core in MHz while it works: of a chain of additions, each of which waits one cycle for the one before.
double measured_mhz();

/// Nanoseconds from one load to the next that needs its answer, in random order over all lines of a buffer of this
/// size; the least of many chases, until that no longer falls, since what disturbs one makes it longer.
double chase_ns(std::uint64_t bytes, std::uint32_t line_bytes);

/// Bytes a nanosecond (GB/s) that one thread reads from a buffer of this size, in order, again and again; the best of
/// many.
double stream_gb_s(std::uint64_t bytes);

/// The same of all threads of the TBB arena together, each with a buffer of its own of this size.
double stream_all_gb_s(std::uint64_t bytes);

}  // namespace raycache::tools
