// A trace of loads that are read twice: first for the memory they read, then for their records. What it takes of
// memory follows from the memory that is read and from the longest warp, not from the number of loads.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "traces/header.hpp"
#include "traces/loads/load_access.hpp"

namespace raycache::traces {

/// One kernel, a launch of the trace.
struct LoadKernel {
    std::uint64_t warps = 0;
    std::uint64_t warps_per_cta = 1;
};

/// Where the accesses of a launch come from.
struct LoadPass {
    /// Of the warp of that number. Warps of a CTA may come in any order, CTAs ascend. Where Header::issue is set, each
    /// warp ends with an access of no lane, which holds its last steps.
    using Use = std::function<void(std::uint64_t warp, const LoadAccess&)>;

    /// Calls use() with every access of launch i. Twice for each launch: the same both times.
    std::function<void(std::size_t launch, const Use&)> read;
    /// Asked after the first time.
    std::function<LoadKernel(std::size_t launch)> kernel;
    /// Called after the first time, with the head that is about to be written.
    std::function<void(Header&)> finish = [](Header&) {};
    std::size_t launches = 1;
    std::string file;  ///< for errors
};

/// Writes `output`: each thread that loads anything begins a ray. `header` without regions, launches and warps, which
/// follow. Throws Error if there is no load, or if the format cannot have the loads.
void write_loads(const LoadPass&, Header header, const std::string& output);

}  // namespace raycache::traces
