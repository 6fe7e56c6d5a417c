// Options that say which GPUs a command asks, and what is changed about them.
#pragma once

#include <string>

#include "tools/jobs/gpu_settings.hpp"
#include "tools/program/command.hpp"

namespace raycache::tools {

struct GpuOptions : GpuSettings {
    Option* add_names(Command&, const std::string& help);  ///< --gpu
    void add_changes(Command&);                            ///< --set --l1-kib --l2-kib --warps-per-sm
    /// Throws UsageError for GPUs whose counts have no name among a profiler's metrics: of three levels of caches, and,
    /// with times, of RT units.
    void check_profiled(const std::vector<cachesim::Gpu>&, bool timed) const;
    /// Throws UsageError unless they are several variants of one GPU, with times: of one clock.
    void check_variants(const std::vector<cachesim::Gpu>&, bool timed) const;
};

}  // namespace raycache::tools
