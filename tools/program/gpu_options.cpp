#include "tools/program/gpu_options.hpp"

#include "cachesim/gpus/gpu_name.hpp"

namespace raycache::tools {

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

}  // namespace raycache::tools
