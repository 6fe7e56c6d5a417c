// A timed replay whose SMs several threads share.
#include <array>
#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>
#include <initializer_list>
#include <random>
#include <thread>

#include "cachesim/replay/timed/each_sm.hpp"
#include "on_threads.hpp"
#include "tests/cachesim/timed_cases.hpp"

using namespace raycache;
using namespace raycache::cachesim;
using namespace raycache::cachesim::test;
using raycache::test::most_threads;
using raycache::test::on_threads;
using traces::ObjectKind;

namespace {

/// Some GPU with enough warps for threads to share.
Gpu random_gpu(std::uint64_t seed) {
    std::mt19937_64 random(seed);
    const auto one_of = [&](std::initializer_list<std::uint32_t> values) {
        return values.begin()[random() % values.size()];
    };
    Gpu gpu = timed_gpu();
    gpu.sms = one_of({5, 7, 12});
    gpu.warps_per_cta = one_of({1, 2, 4});
    gpu.warps_per_sm = 16;
    gpu.levels[0].sets = one_of({1, 3});
    gpu.levels[0].ways = one_of({2, 8, 30});
    gpu.levels[0].allocate = one_of({0, 1}) ? Allocate::on_fill : Allocate::on_miss;
    gpu.levels[1].sets = one_of({2, 8});
    gpu.levels[1].slices = one_of({3, 4, 8});
    Timing& t = *gpu.timing;
    t.schedulers = one_of({1, 2, 4});
    t.node_instructions = one_of({0, 10, 62});
    t.l1_mshrs = one_of({4, 40});
    t.l1_mshr_merges = one_of({1, 8});
    t.l1_port = one_of({0, 1}) ? L1Port::banks : L1Port::tags;
    t.operand_collectors = one_of({0, 0, 4});
    t.crossbar_queues = one_of({0, 1}) ? CrossbarQueues::inputs : CrossbarQueues::outputs;
    if (one_of({0, 0, 1})) {
        gpu.levels.push_back(gpu.levels[1]);
        t.l3_latency = 300;
        t.l3_mshrs = 64;
        t.l3_mshr_merges = 4;
    }
    return gpu;
}

/// By `threads` threads. What is counted, in a list.
std::vector<double> counts(int threads, const Gpu& gpu, const Launch& launch) {
    const TimedStatistics t = on_threads(threads, [&] { return timed(gpu, launch); });
    std::vector<double> all{static_cast<double>(t.cycles),       static_cast<double>(t.instructions),
                            static_cast<double>(t.dram_sectors), static_cast<double>(t.visit_cycles),
                            static_cast<double>(t.warps),        static_cast<double>(t.warp_cycles)};
    for (const LevelAnswers& level : t.levels)
        for (const std::uint64_t count : {level.hits, level.merges, level.line_misses, level.sector_misses})
            all.push_back(static_cast<double>(count));
    for (const auto* resource :
         {&t.issue, &t.l1_port, &t.crossbar, &t.l2_slices, &t.dram, &t.l1_tags, &t.l1_data, &t.l1_mshrs, &t.l2_mshrs})
        all.push_back(resource->busy);
    return all;
}

}  // namespace

TEST_CASE("a timed replay counts the same on one thread and on several, on any GPU", "[threads]") {
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
        const Gpu gpu = random_gpu(seed);
        const Launch launch = random_launch(
            {region(ObjectKind::node, 0x200000, 64, 64, 300), region(ObjectKind::triangle, 0x800000, 48, 48, 200)}, 250,
            20, seed);
        const std::vector<double> alone = counts(1, gpu, launch);
        CAPTURE(seed);
        CHECK(alone[0] > 1000);
        for (const int threads : {2, 3, most_threads}) CHECK(counts(threads, gpu, launch) == alone);
    }
}

TEST_CASE("a timed replay whose lines are numbered as they come counts the same on several threads", "[threads]") {
    Launch launch = random_launch({region(ObjectKind::node, 0x200000, 64, 64, 300)}, 250, 20, 1);
    launch.regions.push_back(region(ObjectKind::texel, 1ull << 40, 16, 4096, 1u << 31));
    const Gpu gpu = random_gpu(1);
    CHECK(counts(3, gpu, launch) == counts(1, gpu, launch));
}

TEST_CASE("SMs that are worth it go to several threads, others stay on one", "[threads]") {
    std::atomic<int> begun{0};
    std::array<std::thread::id, 2> by{};
    const auto meet = [&](std::size_t sm) {  // the other one, for which it takes another thread
        by[sm] = std::this_thread::get_id();
        ++begun;
        const auto start = std::chrono::steady_clock::now();
        while (begun < 2 && std::chrono::steady_clock::now() - start < std::chrono::seconds(20))
            std::this_thread::yield();
    };
    on_threads(2, [&] { for_each_sm(2, true, meet); });
    CHECK(begun == 2);
    CHECK(by[0] != by[1]);
    const auto note = [&](std::size_t sm) { by[sm] = std::this_thread::get_id(); };
    on_threads(2, [&] { for_each_sm(2, false, note); });
    CHECK(by[0] == by[1]);
    on_threads(1, [&] { for_each_sm(2, true, note); });
    CHECK(by[0] == by[1]);
}
