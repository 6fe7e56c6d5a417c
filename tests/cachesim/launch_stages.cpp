// A launch in time, cut into stages, and what it takes beside a steady state, as factors.
#include <catch2/catch.hpp>
#include <cmath>

#include "cachesim/analysis/launch_factors.hpp"
#include "timed_cases.hpp"

using namespace raycache;
using namespace raycache::cachesim;
using namespace raycache::cachesim::test;

namespace {

LaunchStages staged(const Gpu& gpu, const Launch& launch) {
    StagedReplay replay(gpu, launch.regions, 7);
    for (const auto& warp : launch.warps) replay.push(warp);
    return replay.finish();
}

/// A chase through the same ten lines, by each of so many warps; `idle`: numbers of warps that access nothing.
Launch chases(unsigned warps, const std::vector<unsigned>& idle = {}) {
    std::vector<std::uint32_t> lines;
    for (std::uint32_t i = 0; i < 10; ++i) lines.push_back(i * elements_per_line);
    std::vector<std::vector<std::vector<std::uint32_t>>> all(warps, chase(lines));
    for (const unsigned i : idle) all[i].clear();
    return launch_of(all);
}

}  // namespace

TEST_CASE("the stages of a launch add up to its cycles and accesses exactly") {
    for (const unsigned warps : {1u, 2u, 23u, 24u, 26u, 27u, 100u, 301u}) {
        const Launch launch = random_launch(objects, warps, 40, warps);
        for (const Cycle launch_cycles : {0u, 700u}) {
            Gpu gpu = small_timed_gpu();
            gpu.timing->launch_cycles = launch_cycles;
            const TimedStatistics whole = timed(gpu, launch);
            const LaunchStages stages = staged(gpu, launch);
            CAPTURE(warps, launch_cycles);
            CHECK(stages.sample == 7);
            CHECK(stages.all().cycles == whole.cycles);
            CHECK(stages.all().warp_accesses == whole.warp_accesses);
        }
    }
}

TEST_CASE("a stage ends when the first CTA had to wait, and when the last one is dealt out") {
    // One SM of one slot: warps one after the other, the first through DRAM and the others through L1.
    const LaunchStages stages = staged(timed_gpu(), chases(5));
    CHECK(stages.filling.warp_accesses == 10);
    CHECK(stages.full.warp_accesses == 30);
    CHECK(stages.draining.warp_accesses == 10);
    CHECK(stages.filling.cycles > 10 * 500);
    CHECK(stages.full.cycles > 3 * 10 * 30);
    CHECK(stages.full.cycles < 3 * 10 * 60);
    CHECK(stages.draining.cycles < stages.full.cycles);
}

TEST_CASE("CTAs without an access take no slot and end no stage") {
    const LaunchStages plain = staged(timed_gpu(), chases(5));
    CHECK(staged(timed_gpu(), chases(9, {0, 2, 3, 8})) == plain);
    const LaunchStages nothing = staged(timed_gpu(), chases(3, {0, 1, 2}));
    CHECK(nothing.all() == LaunchStages::Stage{});
}

TEST_CASE("a launch of no more CTAs than slots is never full, one of one more only for its last") {
    Gpu gpu = timed_gpu();
    gpu.warps_per_sm = 4;
    for (const unsigned warps : {1u, 4u, 5u}) {
        const LaunchStages stages = staged(gpu, chases(warps));
        CAPTURE(warps);
        CHECK(stages.full == LaunchStages::Stage{});
        const LaunchFactors f = launch_factors(stages, 20);
        CHECK(f.over_steady == static_cast<double>(stages.all().cycles) / (20.0 * 10 * warps));
        CHECK(std::isnan(f.cold));
        CHECK(std::isnan(f.ramp));
        CHECK(std::isnan(f.tail));
        CHECK(f.full_share == 0);
    }
    CHECK(staged(gpu, chases(12)).full.warp_accesses > 0);
}

TEST_CASE("steady state x cold x ramp x tail is the launch") {
    const LaunchStages stages = staged(small_timed_gpu(), random_launch(objects, 200, 40, 3));
    for (const double rate : {1e-3, 2.5, 1e6}) {
        const LaunchFactors f = launch_factors(stages, rate);
        const auto cycles = static_cast<double>(stages.all().cycles);
        CHECK(f.steady_cycles * f.cold * f.ramp * f.tail == Approx(cycles).epsilon(1e-12));
        CHECK(f.over_steady == Approx(f.cold * f.ramp * f.tail).epsilon(1e-12));
        CHECK((f.full_share > 0.5 && f.full_share < 1));
    }
    CHECK(std::isnan(launch_factors(stages, 0).over_steady));
    CHECK(std::isnan(launch_factors({}, 1).over_steady));
}

TEST_CASE("what the beginning and the end add are factors of their own") {
    // Full SMs take 2 cycles an access; the steady state takes 1.6.
    LaunchStages stages;
    stages.full = {2000, 1000};
    stages.filling = {500, 250};
    stages.draining = {500, 250};
    LaunchFactors f = launch_factors(stages, 1.6);
    CHECK(f.cold == Approx(1.25));
    CHECK(f.ramp == Approx(1));
    CHECK(f.tail == Approx(1));
    stages.draining.cycles = 1100;  // 600 more than its share of 3000
    f = launch_factors(stages, 1.6);
    CHECK(f.ramp == Approx(1));
    CHECK(f.tail == Approx(1.2));
    stages.filling.cycles = 800;  // 300 more
    f = launch_factors(stages, 1.6);
    CHECK(f.ramp == Approx(1.1));
    CHECK(f.tail == Approx(3900.0 / 3300));
    CHECK(f.steady_cycles == Approx(2400));
    CHECK(f.full_share == Approx(2.0 / 3));
}
