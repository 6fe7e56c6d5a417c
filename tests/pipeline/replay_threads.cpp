// A functional replay counts the same on any number of threads.
#include <tbb/parallel_for.h>

#include <catch2/catch.hpp>
#include <vector>

#include "cachesim/replay/replay.hpp"
#include "on_threads.hpp"
#include "tests/cachesim/random_launch.hpp"

using namespace raycache;
using namespace raycache::cachesim;
using namespace raycache::cachesim::test;
using raycache::test::on_threads;
using traces::ObjectKind;

namespace {

const std::vector<traces::Region> megakernel{region(ObjectKind::node, 0x7f5000000000, 64, 64, 300),
                                             region(ObjectKind::triangle, 0x7f5000200000, 48, 48, 200),
                                             region(ObjectKind::texel, 0x10000000000, 4, 4, 3000)};
const std::vector<traces::Region> wavefront{
    region(ObjectKind::node, 0x7f5000000000, 64, 64, 300), region(ObjectKind::ray_state, 0x200000, 32, 32, 1000),
    region(ObjectKind::ray_state_write, 0x200000, 32, 32, 1000), region(ObjectKind::sort, 0x800000, 108, 108, 1000)};
const std::vector<traces::Region> sparse{region(ObjectKind::node, 0, 4096, 0xffffffffu, 0xffffffffu)};

/// All that a replay says, before it has finished and after.
struct Counts {
    std::vector<LaunchStatistics> batches_before, batches;
    LineFills fills_before, fills;
    LaunchStatistics all;

    bool operator==(const Counts&) const = default;
};

Counts count(const Gpu& gpu, const Launch& launch, std::size_t kernel_warps = ~std::size_t{0}) {
    Counts counts;
    Replay replay(gpu, launch.regions, 0);
    for (std::size_t w = 0; w < launch.warps.size(); ++w) {
        if (w > 0 && w % kernel_warps == 0) replay.end_kernel();
        if (w % 100 == 40) replay.count_from_here();
        if (w % 100 == 90) replay.count_until_here();
        replay.push(launch.warps[w]);
        if (w + 1 != launch.warps.size() / 4 * 3) continue;
        counts.batches_before = replay.batches();
        counts.fills_before = replay.last_level_fills();
    }
    counts.all = replay.finish();
    counts.batches = replay.batches();
    counts.fills = replay.last_level_fills();
    return counts;
}

/// Long enough that windows are given to threads.
Launch long_launch(const std::vector<traces::Region>& regions, std::uint64_t seed) {
    return random_launch(regions, 200, 250, seed);
}

Gpu gpu_of(unsigned sms, const char* policy) {
    Gpu gpu = small_gpu();
    gpu.sms = sms;
    gpu.warps_per_sm = 8;
    gpu.l1_per_sm = 1 + sms % 2;
    for (CacheGeometry& level : gpu.levels) level.policy = policy;
    return gpu;
}

}  // namespace

TEST_CASE("a launch counts the same on 1, 2, 3 and 8 threads, whatever the policy and the number of SMs", "[threads]") {
    const auto* const policy = GENERATE("fifo", "lru", "random", "tree_plru");
    const auto sms = GENERATE(1u, 4u, 9u);
    CAPTURE(policy, sms);
    const Gpu gpu = gpu_of(sms, policy);
    const Launch launch = long_launch(megakernel, sms);
    const Counts one = on_threads(1, [&] { return count(gpu, launch); });
    CHECK(one.fills.line_misses > one.fills_before.line_misses);
    CHECK((one.fills_before.line_misses > 1000) == (sms < 9));  // in the first window of nine SMs nothing has ended
    for (const int threads : {2, 3, 8}) {
        CAPTURE(threads);
        CHECK(on_threads(threads, [&] { return count(gpu, launch); }) == one);
    }
}

TEST_CASE("kernels of a wavefront, three levels and a fill count the same on any number of threads", "[threads]") {
    Gpu gpu = gpu_of(5, "lru");
    gpu.levels[1].fill_bytes = 64;
    if (GENERATE(false, true)) {
        gpu.levels.push_back(gpu.levels[1]);
        gpu.levels[2].ways = 13;
        gpu.simd_width = 8;
    }
    const Launch launch = long_launch(wavefront, 3);
    const Counts one = on_threads(1, [&] { return count(gpu, launch, 90); });
    for (const int threads : {2, 3, 8}) CHECK(on_threads(threads, [&] { return count(gpu, launch, 90); }) == one);
}

TEST_CASE("lines that are numbered as they are touched count the same on any number of threads", "[threads]") {
    const Launch launch = long_launch(sparse, 4);
    const Counts one = on_threads(1, [&] { return count(gpu_of(4, "lru"), launch); });
    CHECK(on_threads(3, [&] { return count(gpu_of(4, "lru"), launch); }) == one);
}

TEST_CASE("a listener hears on several threads what it hears on one, in the same order", "[threads]") {
    struct Listener : RequestSink {
        bool wants(std::size_t, std::uint32_t) const override { return true; }
        void served(std::size_t level, std::span<const ServedRequest> requests) override {
            for (const ServedRequest& r : requests)
                heard.insert(heard.end(), {level, r.sm, r.address, r.asked, r.missing});
        }
        std::vector<std::uint64_t> heard;
    };
    const Launch launch = long_launch(megakernel, 5);
    const auto listen = [&] {
        Listener listener;
        Replay replay(gpu_of(4, "lru"), launch.regions, 0);
        replay.observe(listener);
        for (const auto& warp : launch.warps) replay.push(warp);
        replay.finish();
        return listener.heard;
    };
    const auto one = on_threads(1, listen);
    CHECK(one.size() > 10'000);
    CHECK(on_threads(3, listen) == one);
}

TEST_CASE("launches that run beside each other count what each counts alone", "[threads]") {
    const Gpu gpu = gpu_of(4, "lru");
    std::vector<Counts> alone(6), beside(6);
    for (std::size_t i = 0; i < alone.size(); ++i)
        alone[i] = on_threads(1, [&] { return count(gpu, long_launch(megakernel, i)); });
    on_threads(3, [&] {
        tbb::parallel_for(
            std::size_t{0}, beside.size(), [&](std::size_t i) { beside[i] = count(gpu, long_launch(megakernel, i)); },
            tbb::simple_partitioner());
    });
    CHECK(beside == alone);
}
