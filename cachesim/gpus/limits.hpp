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

/// The first broken rule, if any: of each value, those of its row in key_tables.hpp; of values together, such as these:
/// sectors no larger than lines, at most 32 to a line, lines and sectors the same in all levels; a cache has at most
/// 2^40 bytes, all caches of a level together at most 2^26 lines (what fits a workstation's memory); latencies grow
/// from level to level.
std::optional<GpuProblem> find_problem(const Gpu&);

}  // namespace raycache::cachesim
