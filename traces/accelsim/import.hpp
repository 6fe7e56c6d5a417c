// An Accel-Sim trace (".traceg", plain or xz) as a trace of this project: each global load becomes a warp access.
//
// What a load reads is an object of its width; where a kind is due (a step, a node), it counts as a node. Each thread
// that loads anything counts as one camera ray, so that "per ray" means per thread. A region has at most 2^30 elements,
// so a load whose lanes read memory further apart (16 GiB with 16 B loads) becomes one access per region. All loads
// stay in memory while the file is read.
#pragma once

#include <cstdint>
#include <string>

#include "traces/accelsim/traceg_parser.hpp"

namespace raycache::traces {

struct ImportSettings {
    /// Makes one access of consecutive loads of a warp that have the same mask, ascending program counters, and read on
    /// in each lane where the load before ended, up to 4096 B: an object that the compiler split.
    bool fuse = false;
    std::string program, command;  ///< for Provenance
};

/// Writes `output`. Throws Error as parse_traceg() does, and if the loads do not fit the regions of the format, or
/// there is none.
TracegKernel import_traceg(const std::string& input, const std::string& output, const ImportSettings&);

}  // namespace raycache::traces
