// The tracer's whole pipeline: scene -> BVH -> sampling -> paths -> SIMT -> trace. One call gives the trace of one
// warp; who asks for warps in order gets a launch, in a file or straight into a replay.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "tracer/paths/integrators/integrator.hpp"
#include "tracer/prepared_scene.hpp"
#include "tracer/sampling/sampling_strategy.hpp"
#include "tracer/simt/execution.hpp"
#include "tracer/simt/thread_map.hpp"
#include "tracer/simt/wavefront.hpp"
#include "traces/header.hpp"
#include "traces/record.hpp"
#include "traces/symbols.hpp"

namespace raycache::tracer {

struct CaptureSettings {
    std::uint32_t width = 512, height = 512;  ///< pixels, 1 … 16384 each
    PathSettings paths;
    StrategySettings strategy;  ///< strategy.samples.spp is N
    /// How many of the N sample indices are traced: a seeded random subset, ascending, the same for every strategy with
    /// this N. With the `samples` thread map whole groups of 32 consecutive indices are chosen instead, rounded up.
    std::uint64_t trace_samples = 8;
    /// Not empty: the first sample index of each launch, instead of chosen ones; multiples of samples_per_launch().
    std::vector<std::uint32_t> first_indices{};
    ThreadMap thread_map = ThreadMap::tile;
    ExecutionSettings execution;
    std::string program, command;  ///< for the provenance
};

inline constexpr std::uint32_t max_resolution = 16384;
/// A wavefront keeps all paths of a launch in memory.
inline constexpr std::uint32_t max_wavefront_paths = 1U << 24;

class Capture {
public:
    /// Throws UsageError for settings out of range.
    Capture(const PreparedScene&, const CaptureSettings&);
    ~Capture();
    Capture(const Capture&) = delete;
    Capture& operator=(const Capture&) = delete;

    const traces::Header& header() const { return header_; }
    const CaptureSettings& settings() const { return settings_; }

    /// Working memory of one thread.
    using Worker = RecordingWorker;
    std::unique_ptr<Worker> make_worker() const;

    /// Traces one warp of a megakernel, replacing `out`. Thread-safe with one worker per thread; the result does not
    /// depend on the worker's past.
    void trace_warp(Worker&, std::uint32_t launch, std::uint32_t warp, traces::WarpTrace& out) const;

    bool is_wavefront() const { return settings_.execution.execution == Execution::wavefront; }
    /// A launch of a wavefront, before its first kernel. Must not outlive this object.
    std::unique_ptr<Wavefront> begin_wavefront(std::uint32_t launch) const;

    /// The symbols of the warp of a megakernel that this worker traced last, for traces::encode_block; empty where they
    /// are not known (BvhLayout::symbols_known()).
    void last_symbols(const Worker&, traces::WarpSymbols& out) const;

    /// The lanes' jobs of a warp, for programs that walk the same rays by other means (benchmarks).
    std::uint32_t lane_jobs(std::uint32_t launch, std::uint32_t warp,
                            std::array<PathLane, traces::warp_lanes>& out) const;

    const PreparedScene& scene() const { return scene_; }
    const SamplingStrategy& strategy() const { return strategy_; }
    const CameraRays& camera() const { return camera_; }
    /// Of the integrator; may be null.
    const IntegratorData* integrator_data() const { return data_.get(); }

private:
    void plan_wavefront();

    const PreparedScene& scene_;
    CaptureSettings settings_;
    SamplingStrategy strategy_;
    CameraRays camera_;
    std::shared_ptr<const IntegratorData> data_;
    LaunchGrid grid_;
    std::unique_ptr<RayOrder> order_;  ///< of a wavefront that sorts
    std::vector<WavefrontKernel> kernels_;
    WavefrontBuffers buffers_;
    std::uint8_t own_regions_ = 0;  ///< index of the first region of the integrator's own
    traces::Header header_;
    /// Base points of each launch: samples_per_launch of them.
    std::vector<std::vector<std::vector<std::uint32_t>>> base_points_;
};

/// Called from any thread with what was finished since the last call.
using Progress = std::function<void(std::uint64_t warps, std::uint64_t rays)>;

/// Traces every launch on all threads of the current TBB arena and writes the file. Its bytes do not depend on the
/// number of threads.
void write_capture(const Capture&, const std::string& path, const Progress&);

}  // namespace raycache::tracer
