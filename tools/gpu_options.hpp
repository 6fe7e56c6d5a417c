// Which GPUs a command asks, and what is changed about them.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>
#include <vector>

#include "cachesim/gpus/gpu.hpp"
#include "tools/outputs.hpp"

namespace raycache::tools {

struct GpuOptions {
    std::vector<std::string> names, changes;
    std::uint32_t warps_per_sm = 0;  ///< 0: as the GPU's file says

    void add_changes(CLI::App&);  ///< --set --warps-per-sm

    /// The changes stand in their names. Throws as load_gpu() does, and UsageError if one of `outputs`, which the
    /// caller is going to write, is the file of a GPU.
    std::vector<cachesim::Gpu> load(const FileNames& outputs) const;
    /// Throws Error for one of load() that cannot be replayed in time; it names the user's file.
    void check_timed(const std::vector<cachesim::Gpu>&) const;
};

}  // namespace raycache::tools
