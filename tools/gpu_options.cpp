#include "tools/gpu_options.hpp"

#include <fmt/format.h>

#include "cachesim/replay/launch_checks.hpp"
#include "traces/error.hpp"

namespace raycache::tools {

void GpuOptions::add_changes(CLI::App& app) {
    app.add_option("--set", changes,
                   "KEY=VALUE: another value for a key of every GPU file, shown beside the GPU's name; may be repeated")
        ->allow_extra_args(false);
    app.add_option("--warps-per-sm", warps_per_sm, "resident warps of an SM, instead of the preset's")
        ->check(CLI::Range(std::uint32_t{1}, std::uint32_t{1024}));
}

std::vector<cachesim::Gpu> GpuOptions::load(const FileNames& outputs) const {
    std::vector<std::string> all_changes = changes;
    if (warps_per_sm != 0) all_changes.push_back(fmt::format("warps_per_sm={}", warps_per_sm));
    std::vector<cachesim::Gpu> gpus;
    for (const std::string& name : names) {
        if (cachesim::is_gpu_file(name)) refuse_overwriting({name}, outputs);
        gpus.push_back(cachesim::load_gpu(name, all_changes));
    }
    return gpus;
}

void GpuOptions::check_timed(const std::vector<cachesim::Gpu>& gpus) const {
    for (std::size_t i = 0; i < gpus.size(); ++i) {
        try {
            cachesim::checked_timed(gpus[i]);
        } catch (const Error& e) {
            if (!cachesim::is_gpu_file(names[i])) throw;
            throw Error(fmt::format("{}: {}", names[i], e.what()));
        }
    }
}

}  // namespace raycache::tools
