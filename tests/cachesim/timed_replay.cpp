#include "cachesim/replay/timed/timed_replay.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "oracle.hpp"
#include "timed_cases.hpp"
#include "traces/error.hpp"

using namespace raycache;
using namespace raycache::cachesim;
using namespace raycache::cachesim::test;
using traces::ObjectKind;

TEST_CASE("a pointer chase takes the latency of the level that answers, times its length") {
    std::vector<std::uint32_t> one_line(100, 0), lines, twice;
    for (std::uint32_t i = 0; i < 512; ++i) lines.push_back(i * elements_per_line);
    twice = lines;  // 512 lines: twice what L1 holds, an eighth of L2
    twice.insert(twice.end(), lines.begin(), lines.end());

    const auto cycles = [](const std::vector<std::uint32_t>& elements) {
        return timed(timed_gpu(), launch_of({chase(elements)})).cycles;
    };
    CHECK(cycles(one_line) == 500 + 99 * 30);
    CHECK(cycles(lines) == 512 * 500);
    CHECK(cycles(twice) == 512 * 500 + 512 * 200);
}

TEST_CASE("a broadcast is one request, and an all-distinct gather takes the port as many cycles as its tags ask for") {
    std::vector<std::uint32_t> same(32, 5), apart;
    for (std::uint32_t i = 0; i < 32; ++i) apart.push_back(i * elements_per_line);
    const auto broadcast = timed(timed_gpu(), launch_of({{same, same}}));
    CHECK(broadcast.levels[0].requests() == 2);
    CHECK(broadcast.l1_port.busy == 2);
    CHECK(broadcast.cycles == 500 + 30);

    const auto gather = timed(timed_gpu(), launch_of({{apart, apart}}));
    CHECK(gather.levels[0].requests() == 64);
    CHECK(gather.levels[0].hits == 32);
    CHECK(gather.l1_port.busy == 2 * 32 / 4);   // 4 tags a cycle
    CHECK(gather.cycles >= 500 + 30 + 2 * 7);   // the last of 32 requests leaves 7 cycles after the first
    CHECK(gather.cycles <= 500 + 30 + 2 * 32);  // crossbar: 32 sectors, one a cycle
}

TEST_CASE("banks take a load's sectors in descending order and wait at the first that is taken") {
    Gpu gpu = timed_gpu();
    gpu.timing->l1_port = L1Port::banks;
    // 4 neighbouring sectors meet 4 banks; 4 sectors of 4 lines in one bank; two pairs.
    CHECK(timed(gpu, launch_of({{{0, 2, 4, 6}}})).l1_port.busy == 1);
    CHECK(timed(gpu, launch_of({{{0, 8, 16, 24}}})).l1_port.busy == 4);
    CHECK(timed(gpu, launch_of({{{0, 2, 8, 10}}})).l1_port.busy == 2);
}

TEST_CASE("a stream from DRAM runs at the rate of DRAM") {
    Gpu gpu = timed_gpu();
    gpu.sms = 8;
    gpu.warps_per_sm = gpu.warps_per_cta = 32;
    gpu.timing->dram_gb_s = 64;  // 2 sectors a cycle, a quarter of what the crossbar carries
    const auto stream = [&](std::uint32_t lines_per_warp) {
        std::vector<std::vector<std::vector<std::uint32_t>>> warps(256);
        for (std::uint32_t w = 0; w < 256; ++w)
            for (std::uint32_t i = 0; i < lines_per_warp; ++i) {
                std::vector<std::uint32_t> lane;
                for (std::uint32_t s = 0; s < 8; s += 2) lane.push_back((i * 256 + w) * elements_per_line + s);
                warps[w].push_back(lane);
            }
        return timed(gpu, launch_of(warps));
    };
    const auto few = stream(8), many = stream(24);
    const double rate =
        static_cast<double>(many.dram_sectors - few.dram_sectors) / static_cast<double>(many.cycles - few.cycles);
    CHECK(rate == Approx(2).epsilon(0.02));
    CHECK(many.dram_sectors == 24 * 256 * 4);
}

TEST_CASE("what enters a level is what missed above it, and every request has an answer") {
    for (const std::uint32_t fill : {32u, 64u, 128u}) {
        Gpu gpu = small_timed_gpu();
        gpu.levels[1].fill_bytes = fill;
        const Launch launch = random_launch(objects, 40, 60, fill);
        const TimedStatistics t = timed(gpu, launch);
        CHECK(t.levels[1].requests() == t.levels[0].misses());
        if (fill == 32) CHECK(t.dram_sectors == t.levels[1].misses());
        CHECK(t.dram_sectors >= t.levels[1].misses());
        CHECK(t.lane_accesses == launch.lane_accesses());
        CHECK(t.cycles > 0);
    }
}

TEST_CASE("without latency a timed replay hits what the functional one hits") {
    for (const std::uint64_t seed : {1, 2, 3, 4}) {
        Gpu gpu = timed_gpu();
        gpu.sms = 3;
        gpu.warps_per_sm = 8;
        gpu.warps_per_cta = 2;
        gpu.levels[0].ways = 4;
        gpu.levels[1].sets = 8;
        gpu.timing->l1_latency = gpu.timing->l2_latency = gpu.timing->l2_far_latency = gpu.timing->dram_latency = 0;
        Idealised ideal;
        ideal.infinite_bandwidth = true;
        const Launch launch =
            random_launch({region(ObjectKind::node, 0x200000, 16, 16, 4000)}, 24, 80, seed);  // all resident
        const TimedStatistics t = timed(gpu, launch, ideal);
        const Counters counts = replay(gpu, launch).all();
        CAPTURE(seed);
        CHECK(t.levels[0].requests() == counts.levels[0].sectors);
        CHECK(static_cast<double>(t.levels[0].misses()) ==
              Approx(static_cast<double>(counts.levels[1].sectors)).epsilon(0.01));
        CHECK(static_cast<double>(t.dram_sectors) == Approx(static_cast<double>(counts.dram_sectors)).epsilon(0.01));
    }
}

TEST_CASE("taking a cost away never makes a launch slower") {
    Gpu gpu = timed_gpu();
    gpu.sms = 2;
    gpu.warps_per_sm = 16;
    gpu.warps_per_cta = 4;
    gpu.levels[0].ways = 4;
    gpu.timing->node_instructions = 20;
    const Launch launch = random_launch({region(ObjectKind::node, 0x200000, 64, 64, 20000)}, 64, 100, 9);
    const auto all = timed(gpu, launch).cycles;
    Idealised l1, l2, bandwidth, latency, full;
    l1.perfect_l1 = l2.perfect_l2 = bandwidth.infinite_bandwidth = latency.no_added_latency = full.full_warps = true;
    for (const Idealised& ideal : {l1, l2, bandwidth, latency, full}) CHECK(timed(gpu, launch, ideal).cycles <= all);
    CHECK(timed(gpu, launch, l1).levels[1].requests() == 0);
    CHECK(timed(gpu, launch, l2).dram_sectors == 0);
}

TEST_CASE("more CTAs than slots, fewer than SMs, and empty warps all end") {
    Gpu gpu = timed_gpu();
    gpu.sms = 2;
    gpu.warps_per_sm = 4;
    gpu.warps_per_cta = 2;
    const auto regions = {region(ObjectKind::node, 0x200000, 64, 64, 500)};
    for (const unsigned warps : {0u, 1u, 3u, 50u}) {
        const Launch launch = random_launch(regions, warps, 30, warps);
        const TimedStatistics t = timed(gpu, launch);
        CHECK(t.lane_accesses == launch.lane_accesses());
        CHECK(t.rays == replay(gpu, launch).all().rays);
    }
}

TEST_CASE("tiny and odd caches hold up the port but lose nothing") {
    for (const std::uint64_t ways : {1, 2, 3}) {
        const Launch launch = random_launch({region(ObjectKind::node, 0x200000, 64, 64, 300)}, 12, 20, ways);
        const TimedStatistics t = timed(cramped_gpu(ways), launch);
        CHECK(t.lane_accesses == launch.lane_accesses());
        CHECK(t.levels[1].requests() == t.levels[0].misses());
    }
}

TEST_CASE("greedy-then-oldest stays with a warp as long as it is ready") {
    Gpu gpu = timed_gpu();
    gpu.warps_per_sm = gpu.warps_per_cta = 2;
    gpu.timing->load_queue = 1;
    // 64 B objects are four loads: one warp's four go first under greedy-then-oldest, the two warps' alternate
    // otherwise.
    Launch launch = random_launch({region(ObjectKind::node, 0x200000, 64, 64, 8)}, 0, 0, 1);
    for (std::uint32_t w = 0; w < 2; ++w) {
        auto warp = std::make_shared<traces::WarpTrace>();
        warp->warp = w;
        traces::Record record;
        record.mask = 1;
        warp->records = {record};
        warp->elements = {4 * w};
        launch.warps.push_back(warp);
    }
    const auto alternating = timed(gpu, launch);
    gpu.scheduler = Scheduler::greedy_then_oldest;
    const auto greedy = timed(gpu, launch);
    CHECK(greedy.visit_cycles < alternating.visit_cycles);
    CHECK(greedy.levels[0] == alternating.levels[0]);
}

TEST_CASE("what a timed replay needs and lacks is said by name") {
    Gpu gpu = timed_gpu();
    gpu.timing.reset();
    CHECK_THROWS_WITH(TimedReplay(gpu, pieces, 0), Catch::Contains("[timing]") && Catch::Contains("timed"));
    gpu = timed_gpu();
    gpu.warps_per_sm = 65;
    CHECK_THROWS_WITH(TimedReplay(gpu, pieces, 0), Catch::Contains("warps_per_sm") && Catch::Contains("65"));
}
