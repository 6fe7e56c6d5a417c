// Scene -> capture -> replay, per sample index, for tests that ask what a strategy does to the caches.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include <tbb/parallel_for.h>

#include "cachesim/replay/replay.hpp"
#include "tests/real_data.hpp"
#include "tracer/capture.hpp"
#include "tracer/prepared_scene.hpp"

namespace raycache::test {

/// A built-in scene, or a .glb of tests/real_data.hpp; nothing, and the test is skipped, if it is absent. Loaded once.
inline const tracer::PreparedScene* find_scene(const std::string& name) {
    static std::map<std::string, std::unique_ptr<tracer::PreparedScene>> loaded;
    const auto found = loaded.find(name);
    if (found != loaded.end()) return found->second.get();
    tracer::SceneRequest request;
    request.source = name;
    if (name.ends_with(".glb")) {
        const auto path = real_scene(name);
        if (!path) return nullptr;
        request.source = *path;
    }
    auto& slot = loaded[name];
    slot = std::make_unique<tracer::PreparedScene>(tracer::load_scene(request, [](const std::string&) {}),
                                                   tracer::BvhSettings{});
    return slot.get();
}

/// Bytes per ray of one sample index.
struct Traffic {
    double l2_bytes = 0;    ///< missed L1
    double dram_bytes = 0;  ///< missed L2 too
};

inline tracer::CaptureSettings capture_settings(const std::string& strategy, const std::string& sequence,
                                                std::uint64_t spp, std::uint64_t trace_samples) {
    tracer::CaptureSettings settings;
    settings.width = settings.height = 256;
    settings.trace_samples = trace_samples;
    settings.strategy.sequence = sequence;
    settings.strategy.decorrelation = strategy;
    settings.strategy.samples.spp = spp;
    settings.strategy.samples.seed = 1;
    settings.strategy.parameters.set("k", 1);
    return settings;
}

inline cachesim::LaunchStatistics replay_launch(const tracer::Capture& capture, std::uint32_t launch,
                                                const cachesim::Gpu& gpu) {
    cachesim::Replay replay(gpu, capture.header().regions, capture.header().launches[launch]);
    const auto worker = capture.make_worker();
    for (std::uint32_t warp = 0; warp < capture.header().warps_per_launch; ++warp) {
        auto trace = std::make_shared<traces::WarpTrace>();
        capture.trace_warp(*worker, launch, warp, *trace);
        replay.push(std::move(trace));
    }
    return replay.finish();
}

/// One entry per traced sample index, on a GTX 980 Ti.
inline std::vector<Traffic> measure(const tracer::PreparedScene& scene, const tracer::CaptureSettings& settings) {
    static const cachesim::Gpu gpu = cachesim::load_gpu("gtx-980-ti");
    const tracer::Capture capture(scene, settings);
    std::vector<Traffic> traffic(capture.header().launches.size());
    tbb::parallel_for(std::uint32_t{0}, static_cast<std::uint32_t>(traffic.size()), [&](std::uint32_t launch) {
        const cachesim::Counters counts = replay_launch(capture, launch, gpu).all();
        const auto rays = static_cast<double>(counts.rays);
        traffic[launch] = {32.0 * static_cast<double>(counts.levels[1].sectors) / rays,
                           32.0 * static_cast<double>(counts.dram_sectors) / rays};
    });
    return traffic;
}

}  // namespace raycache::test
