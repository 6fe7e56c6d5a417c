// raycache_bench [--scene=FILE|NAME] [Google Benchmark options]
#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cstring>
#include <exception>

#include "tools/bench/workload.hpp"

int main(int argc, char** argv) {
    const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
    constexpr const char* option = "--scene=";
    char** end = std::remove_if(argv + 1, argv + argc, [&](const char* argument) {
        if (std::strncmp(argument, option, std::strlen(option)) != 0) return false;
        raycache::bench::choose_scene(argument + std::strlen(option));
        return true;
    });
    argc = static_cast<int>(end - argv);
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
    try {
        benchmark::AddCustomContext("scene", raycache::bench::scene().scene().name);
        benchmark::RunSpecifiedBenchmarks();
    } catch (const std::exception& e) {
        fmt::print(stderr, "raycache_bench: error: {}\n", e.what());
        return 1;
    }
    return 0;
}
