#include "tools/program/gpu_options.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cachesim/gpus/gpu_keys.hpp"
#include "cachesim/gpus/gpu_name.hpp"
#include "traces/did_you_mean.hpp"
#include "traces/error.hpp"

namespace raycache::tools {
namespace {

/// Of KEY=VALUE: that GPU files may have such a key. They all may have the same.
void check_changed_key(std::string& change) {
    const std::size_t equals = change.find('=');
    if (equals == std::string::npos) return;  // whoever reads it says what is expected
    const std::string key = change.substr(0, equals);
    std::vector<std::string> known = cachesim::gpu_key_names();
    for (const char* size : {"l1.size", "l2.size", "l3.size"}) known.emplace_back(size);
    if (std::find(known.begin(), known.end(), key) != known.end()) return;
    throw UsageError(
        fmt::format("--set {}: expected a key of GPU files (see 'raycache list gpus --keys'), found \"{}\"{}", change,
                    key, did_you_mean(key, known)));
}

}  // namespace

Option* GpuOptions::add_names(Command& command, const std::string& help) {
    command.group("GPU");
    Option* option = command.add_option("--gpu", names, help)->check([](std::string& name) {
        name = cachesim::find_gpu_name(name);
    });
    command.group("");
    return option;
}

void GpuOptions::add_changes(Command& command) {
    command.group("GPU");
    command
        .add_option("--set", changes,
                    "another value for a key of every GPU file (docs/gpus.md), shown beside the GPU's name; several "
                    "values make several GPUs, and with --set repeated every combination. Bytes may have a unit: 28KiB")
        ->repeated()
        ->check(check_changed_key)
        ->type_name("KEY=VALUE,...");
    command
        .add_option("--l1-kib", l1_kib,
                    "L1 of so many KiB, or several: its ways change, or its sets where ways would not be whole")
        ->range(std::uint64_t{1}, std::uint64_t{1} << 30);
    command.add_option("--l2-kib", l2_kib, "the same of L2")->range(std::uint64_t{1}, std::uint64_t{1} << 30);
    command.add_option("--warps-per-sm", warps_per_sm, "resident warps of an SM, instead of the preset's")
        ->range(std::uint64_t{1}, std::uint64_t{1024})
        ->default_text("");
    command.group("");
}

void GpuOptions::check_profiled(const std::vector<cachesim::Gpu>& gpus, bool timed) const {
    for (const cachesim::Gpu& gpu : gpus) {
        if (gpu.levels.size() != 2)
            throw UsageError(fmt::format(
                "--gpu {}: expected a GPU of two levels of caches for a profiler's counters, found {}: Nsight "
                "Compute has no name for one between L1 and the shared L2",
                gpu.name, gpu.levels.size()));
        if (timed && gpu.traversal == cachesim::Traversal::rt_unit)
            throw UsageError(
                fmt::format("--timed with --gpu {}; expected traversal = software for a profiler's counters, found "
                            "rt_unit: Nsight Compute's leave out what RT units read",
                            gpu.name));
    }
}

void GpuOptions::check_variants(const std::vector<cachesim::Gpu>& gpus, bool timed) const {
    if (names.size() != 1 || gpus.size() < 2)
        throw UsageError(
            fmt::format("--across-gpus for {} {}; expected several variants of one GPU, such as --l1-kib 128,256",
                        gpus.size(), gpus.size() == 1 ? "GPU" : "GPUs of different names"));
    for (const cachesim::Gpu& gpu : gpus)
        if (timed && gpu.timing->clock_mhz != gpus.front().timing->clock_mhz)
            throw UsageError(
                fmt::format("--across-gpus with --timed: {} MHz in {}, {} MHz in {}; expected one clock, since "
                            "speed-ups are ratios of cycles",
                            gpus.front().timing->clock_mhz, gpus.front().name, gpu.timing->clock_mhz, gpu.name));
}

}  // namespace raycache::tools
