// Replay of the reference traces (tests/folders.hpp: no part of the repository; skipped where they are absent), each
// four times over: 256 warps alone would not fill the SMs.
#include <benchmark/benchmark.h>
#include <unistd.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "cachesim/replay/replay.hpp"
#include "tests/folders.hpp"
#include "tools/bench/workload.hpp"
#include "traces/read_launch.hpp"
#include "traces/rtwarp/import.hpp"

namespace raycache::bench {
namespace {

struct Launch {
    std::vector<traces::Region> regions;
    std::vector<std::shared_ptr<const traces::WarpTrace>> warps;
};

Launch read_rtwarp(const std::string& path) {
    const auto imported =
        std::filesystem::temp_directory_path() / ("raycache_reference_" + std::to_string(getpid()) + ".rct");
    traces::import_rtwarp(path, imported.string(), "raycache_bench", "");
    const traces::Reader reader(imported.string());
    std::filesystem::remove(imported);
    Launch launch{reader.header().regions, {}};
    traces::read_launch(reader, 0, [&](traces::WarpTrace&& warp) {
        launch.warps.push_back(std::make_shared<const traces::WarpTrace>(std::move(warp)));
    });
    return launch;
}

void replay_reference(benchmark::State& state, const char* trace, const char* gpu_name) {
    const std::string path = test::reference_folder() + "/" + trace + ".rtw.zst";
    if (!std::filesystem::exists(path)) {
        state.SkipWithError(("skipped, absent; " + test::reference_remedy()).c_str());
        return;
    }
    const Launch launch = read_rtwarp(path);
    const cachesim::Gpu gpu = cachesim::load_gpu(gpu_name);
    for (auto _ : state) {
        const double start = thread_seconds();
        cachesim::Replay replay(gpu, launch.regions, 0);
        for (int i = 0; i < 4; ++i)
            for (const auto& warp : launch.warps) replay.push(warp);
        const auto accesses = static_cast<double>(replay.finish().all().lane_accesses);
        const double seconds = thread_seconds() - start;
        state.SetIterationTime(seconds);
        state.counters["Mlane_accesses_per_s"] = accesses / seconds / 1e6;
    }
}

const bool registered = [] {
    for (const char* trace : {"hr_coh", "hr_cp", "cp"})
        for (const char* gpu : {"gtx-980-ti", "h100"})
            benchmark::RegisterBenchmark(("replay_reference/" + std::string(trace) + "/" + gpu).c_str(),
                                         [=](benchmark::State& state) { replay_reference(state, trace, gpu); })
                ->Iterations(1)
                ->UseManualTime()
                ->Unit(benchmark::kMillisecond);
    return true;
}();

}  // namespace
}  // namespace raycache::bench
