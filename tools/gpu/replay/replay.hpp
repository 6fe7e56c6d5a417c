// Walks the rays of a package and says in JSON whether they ended where they should, what was read, and how long it
// took: docs/gpu_package.md.
#pragma once

#include <iosfwd>
#include <string>

#include "tools/gpu/replay/backend.hpp"

namespace raycache::gpu {

struct ReplayOptions {
    std::string folder;
    BackendOptions backend;
    std::uint32_t repeats = 10;                ///< timed walks of each kind, behind one that warms up
    std::uint32_t launches = 0;                ///< walked, the first of the package; 0: all
    bool flush_l2 = false;                     ///< before each timed walk
    bool wavefront = true, megakernel = true;  ///< which ways of walking a launch
    bool profile = false;                      ///< each walk once, nothing checked: for a profiler
};

/// The batches of one ray kind and bounce, a warp each, in the order in which warps start them: one launch of a
/// wavefront.
struct KernelPlan {
    std::uint8_t type, bounce;
    WarpPlan plan;
};
std::vector<KernelPlan> kernel_plans(const LaunchPart&);
/// Each warp the batches of its paths, in their order: a megakernel.
WarpPlan megakernel_plan(const LaunchPart&, std::uint32_t warps);

struct ReplayResult {
    std::string json;
    std::uint64_t rays = 0, wrong = 0;  ///< checked, and those that ended elsewhere than expected
};
/// Throws Error.
ReplayResult replay(const ReplayOptions&, Backend&);

/// The program: returns its exit code.
int replay_main(int count, const char* const* words, std::ostream& out, std::ostream& errors);

}  // namespace raycache::gpu
