// An Accel-Sim trace (traceg_parser.hpp, kernel_list.hpp) as a trace of this project: each load of global memory
// becomes a warp access, each kernel a launch; stores, if asked for, become accesses that write.
//
// What a load reads is an object of its width; where a kind is due (a step, a node), it counts as a node; what a store
// writes as a ray state, whose writes go through L1 to the last level (cachesim/MODEL.md). Each thread
// that loads anything counts as one camera ray, so that "per ray" means per thread. A load is one access however far
// apart its lanes are. Files are read twice, and nothing of them is kept (loads/load_writer.hpp). Where kernels have
// different numbers of warps, launches end with warps that read nothing.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "traces/accelsim/access_fuser.hpp"
#include "traces/accelsim/traceg_parser.hpp"

namespace raycache::traces {

struct ImportSettings {
    Fuse fuse = Fuse::independent;
    std::string program, command;  ///< for Provenance
    NullLanes null_lanes = NullLanes::drop_loads;
    bool stores = false;
    /// The loads are visits of a traversal, each of which waits for the one before, as in a capture. Else the trace
    /// says by their registers what waits for what, and what else a warp issues (Header::issue).
    bool traversal = false;
};

/// A kernel that was imported.
struct ImportedKernel {
    std::string file;
    TracegKernel kernel;
};

/// `input`: a kernel's file, a kernelslist.g, or a folder that has one. Writes `output`. Throws Error as parse_traceg()
/// does, and if the loads do not fit the regions of the format, or there is none.
std::vector<ImportedKernel> import_traceg(const std::string& input, const std::string& output, const ImportSettings&);

}  // namespace raycache::traces
