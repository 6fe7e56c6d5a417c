// Which GPUs a job asks, and what is changed about them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "cachesim/gpus/gpu.hpp"
#include "tools/jobs/outputs.hpp"

namespace raycache::tools {

struct GpuSettings {
    std::vector<std::string> names;             ///< presets, or files
    std::vector<std::string> changes;           ///< "KEY=VALUE,VALUE": a GPU of each value (gpu_variants.hpp)
    std::vector<std::uint64_t> l1_kib, l2_kib;  ///< capacities of L1 and L2 in KiB: one GPU per value
    std::uint32_t warps_per_sm = 0;             ///< 0: as the GPU's file says

    /// One of every name and combination of listed changes, which stand in its name. Throws as load_gpu() does, and
    /// UsageError if one of `outputs`, which the caller is going to write, is the file of a GPU.
    std::vector<cachesim::Gpu> load(const FileNames& outputs) const;
    /// The same where `job` takes one GPU: throws UsageError where lists make more of it.
    cachesim::Gpu load_one(const FileNames& outputs, const std::string& job) const;
    bool is_changed() const { return !(changes.empty() && l1_kib.empty() && l2_kib.empty() && warps_per_sm == 0); }
    /// Throws Error for one of load() that cannot be replayed in time; it names the user's file.
    void check_timed(const std::vector<cachesim::Gpu>&) const;
};

}  // namespace raycache::tools
