// A small GPU with round numbers, launches written out, and their timed replay.
#pragma once

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "cachesim/replay/timed/timed_replay.hpp"
#include "random_launch.hpp"

namespace raycache::cachesim::test {

/// One SM, one scheduler, no instructions between accesses; round numbers.
inline Gpu timed_gpu() {
    Gpu gpu;
    gpu.name = "timed";
    gpu.sms = 1;
    gpu.warps_per_sm = gpu.warps_per_cta = 1;
    gpu.levels[0].sets = 4;
    gpu.levels[0].ways = 64;
    gpu.levels[1].sets = 64;
    gpu.levels[1].ways = 16;
    gpu.levels[1].slices = 4;
    Timing t;
    t.clock_mhz = 1000;
    t.schedulers = 1;
    t.l1_latency = 30;
    t.l2_latency = 200;
    t.l2_far_latency = 200;
    t.dram_latency = 500;
    t.l1_mshrs = 256;
    t.l1_mshr_merges = 8;
    t.l2_mshrs = 192;
    t.l2_mshr_merges = 4;
    t.dram_channels = 4;
    t.dram_gb_s = 256;  // 8 sectors a cycle
    gpu.timing = t;
    return gpu;
}

/// Three SMs that hold little, and objects that do not fit.
inline Gpu small_timed_gpu() {
    Gpu gpu = timed_gpu();
    gpu.sms = 3;
    gpu.warps_per_sm = 8;
    gpu.warps_per_cta = 2;
    gpu.levels[0].ways = 4;
    gpu.levels[1].sets = 2;
    return gpu;
}
inline const std::vector<traces::Region> objects{region(traces::ObjectKind::node, 0x200000, 64, 64, 3000),
                                                 region(traces::ObjectKind::triangle, 0x800000, 48, 48, 2000)};

/// Too few lines, registers and merges for its warps, in odd numbers.
inline Gpu cramped_gpu(std::uint64_t ways) {
    Gpu gpu = timed_gpu();
    gpu.warps_per_sm = 6;
    gpu.warps_per_cta = 3;
    gpu.levels[0].sets = 1;
    gpu.levels[0].ways = ways;
    gpu.levels[1].slices = 3;
    gpu.levels[1].sets = 5;
    gpu.levels[1].ways = 1;
    gpu.timing->l1_mshrs = 2;
    gpu.timing->l1_mshr_merges = gpu.timing->l2_mshr_merges = 1;
    gpu.timing->l2_mshrs = 1;
    gpu.timing->dram_channels = 2;
    return gpu;
}

/// Elements of 16 bytes: one load each.
inline const std::vector<traces::Region> pieces{region(traces::ObjectKind::node, 0x200000, 16, 16, 1u << 24)};

inline Launch launch_of(const std::vector<std::vector<std::vector<std::uint32_t>>>& warps) {
    Launch launch{pieces, {}};
    for (const auto& accesses : warps) {
        auto warp = std::make_shared<traces::WarpTrace>();
        warp->warp = static_cast<std::uint32_t>(launch.warps.size());
        for (const auto& elements : accesses) {
            traces::Record record;
            record.mask = static_cast<std::uint32_t>((std::uint64_t{1} << elements.size()) - 1);
            warp->records.push_back(record);
            warp->elements.insert(warp->elements.end(), elements.begin(), elements.end());
        }
        launch.warps.push_back(std::move(warp));
    }
    return launch;
}

inline TimedStatistics timed(const Gpu& gpu, const Launch& launch, const Idealised& ideal = {},
                             PortPath path = PortPath::fast) {
    TimedReplay replay(gpu, launch.regions, 0, ideal, path);
    for (const auto& warp : launch.warps) replay.push(warp);
    return replay.finish();
}

/// One lane reads these elements one after the other.
inline std::vector<std::vector<std::uint32_t>> chase(const std::vector<std::uint32_t>& elements) {
    std::vector<std::vector<std::uint32_t>> accesses;
    for (const std::uint32_t e : elements) accesses.push_back({e});
    return accesses;
}

inline constexpr std::uint32_t elements_per_line = 8;

}  // namespace raycache::cachesim::test
