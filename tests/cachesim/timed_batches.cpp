// What a timed replay counts between "count from here" and "count until here".
#include <catch2/catch.hpp>

#include "timed_cases.hpp"

using namespace raycache;
using namespace raycache::cachesim;
using namespace raycache::cachesim::test;
using traces::ObjectKind;

namespace {

Launch nodes_of(unsigned warps, std::uint64_t seed) {
    return random_launch({region(ObjectKind::node, 0x200000, 64, 64, 2000)}, warps, 50, seed);
}

Gpu two_sms() {
    Gpu gpu = timed_gpu();
    gpu.sms = 2;
    gpu.warps_per_sm = 8;
    gpu.warps_per_cta = 2;
    gpu.timing->launch_cycles = 700;
    gpu.timing->node_instructions = 10;
    return gpu;
}

void check_same_counts(const TimedStatistics& a, const TimedStatistics& b) {
    CHECK(a.cycles == b.cycles);
    CHECK(a.rays == b.rays);
    CHECK(a.loads == b.loads);
    CHECK(a.instructions == b.instructions);
    CHECK(a.levels[0] == b.levels[0]);
    CHECK(a.levels[1] == b.levels[1]);
    CHECK(a.dram_sectors == b.dram_sectors);
    CHECK(a.visit_cycles == b.visit_cycles);
    CHECK(a.warps == b.warps);
    CHECK(a.warp_cycles == b.warp_cycles);
    CHECK(a.l1_port.busy == b.l1_port.busy);
    CHECK(a.l2_mshrs.busy == b.l2_mshrs.busy);
    CHECK(a.l1_port.copies == b.l1_port.copies);
    CHECK(a.warp_slots == b.warp_slots);
}

}  // namespace

TEST_CASE("batches that follow each other take the time of the whole, and count what it counts") {
    const Launch launch = nodes_of(60, 5);
    for (const std::size_t kernel : {0u, 30u}) {  // begins with this warp, too
        const auto run = [&](std::size_t every) {
            TimedReplay replay(two_sms(), launch.regions, 0);
            for (std::size_t w = 0; w < launch.warps.size(); ++w) {
                if (w > 0 && w == kernel) replay.end_kernel();
                if (every > 0 && w % every == 0) replay.count_from_here();
                replay.push(launch.warps[w]);
            }
            const TimedStatistics all = replay.finish();
            return std::pair{all, replay.batches()};
        };
        const TimedStatistics whole = run(0).first;
        CHECK(run(0).second.size() == 1);
        for (const std::size_t every : {2u, 10u, 30u}) {
            const auto [all, batches] = run(every);
            CAPTURE(kernel, every);
            CHECK(batches.size() == 60 / every);
            check_same_counts(all, whole);
            for (const TimedStatistics& batch : batches) {
                CHECK(batch.l1_port.busy <= static_cast<double>(2 * batch.cycles));
                CHECK(batch.occupancy() <= 1);
            }
        }
    }
}

TEST_CASE("a batch after a warm-up finds what that left, and its time begins when its first warp does") {
    // One SM, one warp at a time. A chase through ten lines of DRAM, then through the same in L1.
    std::vector<std::uint32_t> lines;
    for (std::uint32_t i = 0; i < 10; ++i) lines.push_back(i * elements_per_line);
    const Launch launch = launch_of({chase(lines), chase(lines), chase(lines)});
    TimedReplay replay(timed_gpu(), launch.regions, 0);
    replay.count_until_here();
    replay.push(launch.warps[0]);
    replay.count_from_here();
    replay.push(launch.warps[1]);
    replay.count_until_here();
    replay.push(launch.warps[2]);
    const TimedStatistics t = replay.finish();
    CHECK(t.levels[0] == LevelAnswers{10, 0, 0, 0});
    CHECK(t.dram_sectors == 0);
    CHECK(t.warps == 1);
    CHECK(t.warp_accesses == 10);
    CHECK(t.warp_cycles == 10 * 30);
    // To the end of the window of 170 cycles in which its slot is free again.
    CHECK(t.cycles == 2 * 170);
    CHECK(replay.batches().size() == 1);
}

TEST_CASE("what is not counted to the end of the launch ends with the next warp, or never began") {
    const Launch launch = nodes_of(40, 6);
    TimedReplay replay(two_sms(), launch.regions, 0);
    replay.count_until_here();
    for (const auto& warp : launch.warps) replay.push(warp);
    replay.count_from_here();
    const TimedStatistics t = replay.finish();
    CHECK(t.cycles == 0);
    CHECK(t.levels[0].requests() == 0);
    CHECK(replay.batches().empty());
}
