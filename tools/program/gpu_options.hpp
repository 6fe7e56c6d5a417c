// Which GPUs a command asks, and what is changed about them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "cachesim/gpus/gpu.hpp"
#include "tools/jobs/outputs.hpp"
#include "tools/program/command.hpp"

namespace raycache::tools {

struct GpuOptions {
    std::vector<std::string> names, changes;
    std::vector<std::uint64_t> l1_kib, l2_kib;
    std::uint32_t warps_per_sm = 0;  ///< 0: as the GPU's file says

    Option* add_names(Command&, const std::string& help);  ///< --gpu
    void add_changes(Command&);                            ///< --set --l1-kib --l2-kib --warps-per-sm

    /// One of every name and combination of listed changes, which stand in its name. Throws as load_gpu() does, and
    /// UsageError if one of `outputs`, which the caller is going to write, is the file of a GPU.
    std::vector<cachesim::Gpu> load(const FileNames& outputs) const;
    /// The same where `command` takes one GPU: throws UsageError where lists make more of it.
    cachesim::Gpu load_one(const FileNames& outputs, const std::string& command) const;
    bool is_changed() const { return !(changes.empty() && l1_kib.empty() && l2_kib.empty() && warps_per_sm == 0); }
    /// Throws Error for one of load() that cannot be replayed in time; it names the user's file.
    void check_timed(const std::vector<cachesim::Gpu>&) const;
};

}  // namespace raycache::tools
