// Which GPUs can be replayed: the rules that a preset, a user's file or a Gpu made by a program must keep.
#pragma once

#include <optional>
#include <string>

#include "cachesim/gpus/gpu.hpp"

namespace raycache::cachesim {

struct GpuProblem {
    std::string key;      ///< "sms", "l1.ways": where in a preset to look
    std::string message;  ///< "expected …, found …; remedy"
};

/// The first broken rule, if any:
/// counts are positive; sms <= 4096, warps_per_sm <= 1024, warps_per_cta <= 64, l1_per_sm <= 8;
/// line size a power of two from 16 to 4096 bytes; sector size a power of two from 4 bytes to the line size, at most 32
/// sectors per line, both the same in L1 and L2; a cache has at most 2^40 bytes; all caches of a level together at most
/// 2^26 lines (what fits a workstation's memory); the policy is known.
std::optional<GpuProblem> find_problem(const Gpu&);

}  // namespace raycache::cachesim
