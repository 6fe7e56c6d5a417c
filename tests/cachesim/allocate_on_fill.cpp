// When a miss takes a line of a cache: at once, or when the data arrive.
#include <catch2/catch.hpp>

#include "timed_cases.hpp"

using namespace raycache;
using namespace raycache::cachesim;
using namespace raycache::cachesim::test;
using traces::ObjectKind;

namespace {

TimedStatistics timed_with(Gpu gpu, Allocate l1, Allocate l2, const Launch& launch, const Idealised& ideal = {}) {
    gpu.levels[0].allocate = l1;
    gpu.levels[1].allocate = l2;
    return timed(gpu, launch, ideal);
}

}  // namespace

TEST_CASE("on fill, a line can be read until the one that replaces it is there") {
    Gpu gpu = timed_gpu();
    gpu.warps_per_sm = gpu.warps_per_cta = 2;
    gpu.levels[0].sets = gpu.levels[0].ways = 1;
    // Both warps read line 0, there at 500. Then warp 0 reads line 1, there at 1000, while warp 1 reads line 0 on.
    const Launch launch = launch_of({chase({0, elements_per_line}), chase({0, 0, 0, 0, 0})});
    const auto on_fill = timed_with(gpu, Allocate::on_fill, Allocate::on_miss, launch);
    CHECK(on_fill.levels[0].line_misses == 2);
    CHECK(on_fill.levels[0].merges == 1);
    CHECK(on_fill.levels[0].hits == 4);

    // On miss line 1 takes the place of line 0 at once: warp 1 waits for a line to be free and misses again.
    const auto on_miss = timed_with(gpu, Allocate::on_miss, Allocate::on_miss, launch);
    CHECK(on_miss.levels[0].line_misses == 3);
    CHECK(on_miss.levels[0].hits == 3);
    CHECK(on_miss.cycles > on_fill.cycles);
}

TEST_CASE("on fill, the L2 keeps a line until the one that replaces it is there") {
    Gpu gpu = timed_gpu();
    gpu.sms = 2;
    gpu.levels[0].sets = gpu.levels[0].ways = 1;
    gpu.levels[1].sets = gpu.levels[1].ways = gpu.levels[1].slices = 1;
    gpu.timing->dram_channels = 1;
    // SM 0: line 0 (there at 500), then line 1, asked of L2 at about 500 and there 300 later. SM 1 spends 500 cycles on
    // line 0 too, 30 on a hit, and asks for another sector of line 0: its line is still there or not.
    const Launch launch = launch_of({chase({0, elements_per_line}), chase({0, 0, 2})});
    const auto on_fill = timed_with(gpu, Allocate::on_miss, Allocate::on_fill, launch);
    const auto on_miss = timed_with(gpu, Allocate::on_miss, Allocate::on_miss, launch);
    CHECK(on_fill.levels[1].line_misses == 2);
    CHECK(on_fill.levels[1].sector_misses == 1);
    CHECK(on_miss.levels[1].line_misses == 3);
    CHECK(on_miss.levels[1].sector_misses == 0);
}

TEST_CASE("in caches that hold everything it makes no difference when a line is taken") {
    Gpu gpu = timed_gpu();
    gpu.sms = 3;
    gpu.warps_per_sm = 8;
    gpu.warps_per_cta = 2;
    const Launch launch = random_launch({region(ObjectKind::node, 0x200000, 64, 64, 300)}, 40, 60, 5);
    const auto on_miss = timed_with(gpu, Allocate::on_miss, Allocate::on_miss, launch);
    for (const Allocate l1 : {Allocate::on_miss, Allocate::on_fill}) {
        for (const Allocate l2 : {Allocate::on_miss, Allocate::on_fill}) {
            const auto other = timed_with(gpu, l1, l2, launch);
            CHECK(other.cycles == on_miss.cycles);
            CHECK(other.levels[0].hits == on_miss.levels[0].hits);
            CHECK(other.levels[0].merges == on_miss.levels[0].merges);
            CHECK(other.dram_sectors == on_miss.dram_sectors);
        }
    }
}

TEST_CASE("caches that allocate on fill lose nothing, however few lines, registers and merges they have") {
    for (const std::uint32_t fill : {32u, 64u, 128u}) {
        for (const std::uint64_t ways : {1, 2, 3}) {
            Gpu gpu = cramped_gpu(ways);
            gpu.levels[1].fill_bytes = fill;
            const Launch launch = random_launch({region(ObjectKind::node, 0x200000, 64, 64, 300)}, 12, 20, ways);
            const auto t = timed_with(gpu, Allocate::on_fill, Allocate::on_fill, launch);
            CHECK(t.lane_accesses == launch.lane_accesses());
            CHECK(t.levels[1].requests() == t.levels[0].misses());
            CHECK(t.dram_sectors >= t.levels[1].misses());
            if (fill == 32) CHECK(t.dram_sectors == t.levels[1].misses());
        }
    }
}

TEST_CASE("without latency a cache that allocates on fill hits what one that allocates on miss hits") {
    Gpu gpu = timed_gpu();
    gpu.sms = 3;
    gpu.warps_per_sm = 8;
    gpu.warps_per_cta = 2;
    gpu.levels[0].ways = 4;
    gpu.levels[1].sets = 8;
    gpu.timing->l1_latency = gpu.timing->l2_latency = gpu.timing->l2_far_latency = gpu.timing->dram_latency = 0;
    const Launch launch = random_launch({region(ObjectKind::node, 0x200000, 16, 16, 4000)}, 24, 80, 1);
    Idealised ideal;
    ideal.infinite_bandwidth = true;
    const auto on_miss = timed_with(gpu, Allocate::on_miss, Allocate::on_miss, launch, ideal);
    const auto on_fill = timed_with(gpu, Allocate::on_fill, Allocate::on_fill, launch, ideal);
    CHECK(on_fill.levels[0].requests() == on_miss.levels[0].requests());
    CHECK(static_cast<double>(on_fill.levels[0].misses()) ==
          Approx(static_cast<double>(on_miss.levels[0].misses())).epsilon(0.01));
    CHECK(static_cast<double>(on_fill.dram_sectors) == Approx(static_cast<double>(on_miss.dram_sectors)).epsilon(0.01));
}
