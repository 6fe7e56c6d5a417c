#include "tools/jobs/gpu_settings.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cachesim/gpus/gpu_name.hpp"
#include "cachesim/replay/launch_checks.hpp"
#include "tools/jobs/gpu_variants.hpp"
#include "traces/error.hpp"

namespace raycache::tools {

std::vector<cachesim::Gpu> GpuSettings::load(const FileNames& outputs) const {
    std::vector<std::vector<std::string>> lists;
    for (const std::string& change : changes) lists.push_back(listed_changes(change));
    const auto add_sizes = [&](const char* key, const std::vector<std::uint64_t>& sizes) {
        if (sizes.empty()) return;
        std::string list;
        for (const std::uint64_t kib : sizes) list += fmt::format("{}{}KiB", list.empty() ? "" : ",", kib);
        lists.push_back(listed_changes(fmt::format("{}.size={}", key, list)));
    };
    add_sizes("l1", l1_kib);
    add_sizes("l2", l2_kib);
    if (warps_per_sm != 0) lists.push_back({fmt::format("warps_per_sm={}", warps_per_sm)});
    std::vector<cachesim::Gpu> gpus;
    for (const std::string& name : names) {
        if (std::count(names.begin(), names.end(), name) > 1)
            throw UsageError(fmt::format("--gpu: expected each GPU once, found {} twice", name));
        if (cachesim::is_gpu_file(name)) refuse_overwriting({name}, outputs);
        for (cachesim::Gpu& gpu : load_gpu_variants(name, lists)) gpus.push_back(std::move(gpu));
    }
    if (gpus.size() > max_gpu_variants)
        throw UsageError(fmt::format("expected at most {} GPUs, found {}; list fewer values with --set",
                                     max_gpu_variants, gpus.size()));
    return gpus;
}

cachesim::Gpu GpuSettings::load_one(const FileNames& outputs, const std::string& job) const {
    const auto gpus = load(outputs);
    if (gpus.size() == 1) return gpus.front();
    throw UsageError(
        fmt::format("'raycache {}' takes one GPU; expected one value for each key, found lists that make "
                    "{} GPUs, such as {} (replay and compare take several)",
                    job, gpus.size(), gpus.front().name));
}

void GpuSettings::check_timed(const std::vector<cachesim::Gpu>& gpus) const {
    for (std::size_t i = 0; i < gpus.size(); ++i) {
        try {
            cachesim::checked_timed(gpus[i]);
        } catch (const Error& e) {
            const std::string& name = names[i / (gpus.size() / names.size())];  // each makes as many variants
            if (!cachesim::is_gpu_file(name)) throw;
            throw Error(fmt::format("{}: {}", name, e.what()));
        }
    }
}

}  // namespace raycache::tools
