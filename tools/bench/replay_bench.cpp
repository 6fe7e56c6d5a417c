// Replay of the Cranley–Patterson trace: warps from memory, and warps decoded from the file's blocks.
#include <benchmark/benchmark.h>
#include <tbb/task_arena.h>
#include <unistd.h>

#include <filesystem>

#include "cachesim/replay/replay.hpp"
#include "cachesim/replay/timed/timed_replay.hpp"
#include "tools/bench/workload.hpp"
#include "traces/reader.hpp"

namespace raycache::bench {
namespace {

/// A trace file on disk for the life of the program.
class TraceFile {
public:
    TraceFile()
        : path_(std::filesystem::temp_directory_path() / ("raycache_replay_" + std::to_string(getpid()) + ".rct")) {
        tracer::write_capture(*make_capture("cranley-patterson"), path_.string(), {});
    }
    ~TraceFile() { std::filesystem::remove(path_); }
    TraceFile(const TraceFile&) = delete;
    TraceFile& operator=(const TraceFile&) = delete;
    std::string path() const { return path_.string(); }

private:
    std::filesystem::path path_;
};

const TraceFile& trace_file() {
    static const TraceFile file;
    return file;
}

void report_rate(benchmark::State& state, std::uint64_t lane_accesses, double seconds) {
    state.SetIterationTime(seconds);
    state.counters["Mlane_accesses_per_s"] = static_cast<double>(lane_accesses) / seconds / 1e6;
}

void decode(benchmark::State& state) {
    const traces::Reader reader(trace_file().path());
    std::vector<traces::WarpTrace> warps;
    for (auto _ : state) {
        std::uint64_t accesses = 0;
        const double start = thread_seconds();
        for (std::size_t b = 0; b < reader.blocks().size(); ++b) {
            reader.read_block(b, warps);
            accesses += reader.blocks()[b].lane_accesses;
        }
        report_rate(state, accesses, thread_seconds() - start);
    }
}

using Warps = std::vector<std::shared_ptr<const traces::WarpTrace>>;

/// All warps of the file, decoded.
Warps all_warps(const traces::Reader& reader) {
    Warps all;
    std::vector<traces::WarpTrace> warps;
    for (std::size_t b = 0; b < reader.blocks().size(); ++b) {
        reader.read_block(b, warps);
        for (traces::WarpTrace& w : warps) all.push_back(std::make_shared<const traces::WarpTrace>(std::move(w)));
    }
    return all;
}

/// `decoded`: warps stand in memory, as in the fused pipeline; else the time to decode them counts.
void replay(benchmark::State& state, const char* gpu_name, bool decoded) {
    const traces::Reader reader(trace_file().path());
    const cachesim::Gpu gpu = cachesim::load_gpu(gpu_name);
    const Warps all = decoded ? all_warps(reader) : Warps{};
    for (auto _ : state) {
        const double start = thread_seconds();
        cachesim::Replay model(gpu, reader.header().regions, reader.header().launches.front());
        for (const auto& warp : all) model.push(warp);
        if (!decoded) {
            std::vector<traces::WarpTrace> warps;
            for (std::size_t b = 0; b < reader.blocks().size(); ++b) {
                reader.read_block(b, warps);
                for (traces::WarpTrace& w : warps) model.push(std::make_shared<const traces::WarpTrace>(std::move(w)));
            }
        }
        const cachesim::LaunchStatistics counts = model.finish();
        report_rate(state, counts.all().lane_accesses, thread_seconds() - start);
    }
}

/// Warps from memory.
void timed_replay(benchmark::State& state, const char* gpu_name) {
    const traces::Reader reader(trace_file().path());
    const cachesim::Gpu gpu = cachesim::load_gpu(gpu_name);
    const Warps all = all_warps(reader);
    for (auto _ : state) {
        const double start = thread_seconds();
        cachesim::TimedReplay model(gpu, reader.header().regions, reader.header().launches.front());
        for (const auto& warp : all) model.push(warp);
        const cachesim::TimedStatistics counts = model.finish();
        const double seconds = thread_seconds() - start;
        report_rate(state, counts.lane_accesses, seconds);
        state.counters["Mwarp_accesses_per_s"] = static_cast<double>(counts.warp_accesses) / seconds / 1e6;
        state.counters["Mwarp_instructions_per_s"] = static_cast<double>(counts.instructions) / seconds / 1e6;
    }
}

BENCHMARK(decode)->Iterations(1)->UseManualTime()->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(replay, gtx_980_ti, "gtx-980-ti", true)
    ->Iterations(1)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(replay, h100, "h100", true)->Iterations(1)->UseManualTime()->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(replay, gtx_980_ti_from_file, "gtx-980-ti", false)
    ->Iterations(1)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(replay, v100, "v100", true)->Iterations(1)->UseManualTime()->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(replay, rtx_3070, "rtx-3070", true)->Iterations(1)->UseManualTime()->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(replay, rtx_4090, "rtx-4090", true)->Iterations(1)->UseManualTime()->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(timed_replay, gtx_980_ti, "gtx-980-ti")
    ->Iterations(1)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(timed_replay, v100, "v100")->Iterations(1)->UseManualTime()->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(timed_replay, rtx_3070, "rtx-3070")->Iterations(1)->UseManualTime()->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace raycache::bench
