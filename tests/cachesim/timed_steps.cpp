// Warps whose traces say what waits for what. Cycles by hand: with this GPU's round numbers a load of nothing that is
// cached takes 500, one that hits 30, and a warp issues one load a cycle.
#include <catch2/catch.hpp>

#include "timed_cases.hpp"

using namespace raycache;
using namespace raycache::cachesim;
using namespace raycache::cachesim::test;

namespace {

using Steps = std::vector<traces::IssueStep>;

/// Of one warp, of which a lane reads these lines one after the other.
Launch steps_launch(const std::vector<std::uint32_t>& lines, const Steps& steps, unsigned warps = 1) {
    std::vector<std::uint32_t> elements;
    for (const std::uint32_t line : lines) elements.push_back(line * elements_per_line);
    Launch launch = launch_of(std::vector(warps, chase(elements)));
    for (auto& warp : launch.warps) {
        auto with = std::make_shared<traces::WarpTrace>(*warp);
        with->issue = steps;
        warp = std::move(with);
    }
    return launch;
}

Gpu steps_gpu() {
    Gpu gpu = timed_gpu();
    gpu.timing->instruction_latency = 4;
    gpu.timing->dependent_chains = 1;
    gpu.timing->node_instructions = 100;  // of traces without steps alone
    gpu.timing->shading_instructions = 100;
    return gpu;
}

Cycle cycles_of(const Gpu& gpu, const std::vector<std::uint32_t>& lines, const Steps& steps) {
    return timed(gpu, steps_launch(lines, steps)).cycles;
}

}  // namespace

TEST_CASE("a load waits for the load that a step names, and for no other") {
    const Gpu gpu = steps_gpu();
    CHECK(cycles_of(gpu, {0, 1}, {{1, 1, 0}, {2, 0, 0}}) == 500 + 500);
    CHECK(cycles_of(gpu, {0, 1}, {{2, 0, 0}}) == 501);
    CHECK(cycles_of(gpu, {0, 1, 2, 3}, {{4, 0, 0}}) == 503);
    // Line 0 again hits at 530; line 1 is there at 1001. What waits for the hit is there at 1030, for the miss at 1501.
    CHECK(cycles_of(gpu, {0, 0, 1, 2}, {{1, 1, 0}, {3, 2, 0}, {4, 0, 0}}) == 1030);
    CHECK(cycles_of(gpu, {0, 0, 1, 2}, {{1, 1, 0}, {3, 3, 0}, {4, 0, 0}}) == 1501);
    CHECK(cycles_of(gpu, {0, 0, 1, 2}, {{1, 1, 0}, {3, 2, 0}, {3, 3, 0}, {4, 0, 0}}) == 1501);
}

TEST_CASE("instructions issue while loads are under way, and hold up what stands behind them") {
    const Gpu gpu = steps_gpu();
    // From cycle 1 on, ten of a chain of latency 4: the last one issues in cycle 37, the load in 38.
    CHECK(cycles_of(gpu, {0, 1}, {{1, 0, 10}, {2, 0, 0}}) == 38 + 500);
    CHECK(cycles_of(gpu, {0, 1}, {{1, 1, 10}, {2, 0, 0}}) == 500 + 37 + 500);
    CHECK(cycles_of(gpu, {0, 1}, {{1, 0, 10}, {1, 1, 10}, {2, 0, 0}}) == 500 + 37 + 500);
    CHECK(cycles_of(gpu, {0, 1}, {{0, 0, 10}, {2, 0, 0}}) == 37 + 501);
    CHECK(cycles_of(gpu, {0}, {{1, 1, 10}}) == 500 + 37);
    CHECK(cycles_of(gpu, {0}, {{1, 0, 1000}}) == 1 + 3997);
    const TimedStatistics t = timed(gpu, steps_launch({0, 1}, {{0, 0, 3}, {1, 1, 10}, {2, 0, 7}}));
    CHECK(t.instructions == 2 + 20);
    CHECK(t.loads == 2);
    CHECK(t.warp_accesses == 2);
}

TEST_CASE("a warp has 64 accesses under way, and the next one waits for the oldest") {
    const Gpu gpu = steps_gpu();
    std::vector<std::uint32_t> lines(65);
    for (std::uint32_t i = 0; i < 65; ++i) lines[i] = i;
    const Cycle all = cycles_of(gpu, lines, {{65, 0, 0}});
    lines.pop_back();
    const Cycle fewer = cycles_of(gpu, lines, {{64, 0, 0}});
    CHECK(fewer >= 563);
    CHECK(fewer < 700);
    CHECK(all == 500 + 500);
}

TEST_CASE(
    "through operand collectors loads wait for the same, and the chain of a trace without steps is that of one with") {
    Gpu gpu = steps_gpu();
    gpu.timing->operand_collectors = 2;
    CHECK(cycles_of(gpu, {0, 1}, {{2, 0, 0}}) == 500 + 1);
    CHECK(cycles_of(gpu, {0, 1}, {{1, 1, 0}, {2, 0, 0}}) == 500 + 500);
    CHECK(cycles_of(gpu, {0, 0, 1, 2}, {{1, 1, 0}, {3, 2, 0}, {4, 0, 0}}) == 1030);
    gpu.timing->node_instructions = gpu.timing->shading_instructions = 0;
    for (const unsigned warps : {1u, 6u}) {
        gpu.warps_per_sm = gpu.warps_per_cta = warps;
        const std::vector<std::uint32_t> lines{0, 5, 5, 70, 0, 3, 70, 9};
        Steps chain;
        for (std::uint32_t i = 1; i <= lines.size(); ++i) chain.push_back({i, i, 0});
        const TimedStatistics with = timed(gpu, steps_launch(lines, chain, warps));
        const TimedStatistics without = timed(gpu, steps_launch(lines, {}, warps));
        CHECK(with.cycles == without.cycles);
        CHECK(with.levels[0].hits == without.levels[0].hits);
        CHECK(with.loads == without.loads);
    }
}

TEST_CASE("steps are those of the SM where an RT unit would visit, and of narrow vectors and filled warps as well") {
    Gpu gpu = steps_gpu();
    gpu.rt_unit.emplace();
    gpu.traversal = Traversal::rt_unit;
    const Steps chain{{1, 1, 0}, {2, 0, 0}}, free{{2, 0, 0}};
    CHECK(cycles_of(gpu, {0, 1}, chain) == 1000);
    CHECK(cycles_of(gpu, {0, 1}, free) == 501);
    gpu = steps_gpu();
    gpu.simd_width = 8;
    Launch launch = launch_of({{std::vector<std::uint32_t>(32, 0), std::vector<std::uint32_t>(32, 8)}});
    auto warp = std::make_shared<traces::WarpTrace>(*launch.warps[0]);
    warp->issue = chain;
    launch.warps[0] = warp;
    // Four vectors a record; the first of the second waits for the fourth of the first, which merged in cycle 3.
    CHECK(timed(gpu, launch).warp_accesses == 8);
    CHECK(timed(gpu, launch).cycles == 1000);
    Idealised full;
    full.full_warps = true;
    CHECK(timed(steps_gpu(), steps_launch({0, 1}, chain), full).cycles == 501);
    CHECK(timed(steps_gpu(), steps_launch({0, 1}, chain), full).warp_accesses == 1);
}

TEST_CASE("a store is an instruction that nothing waits for") {
    Gpu gpu = steps_gpu();
    Launch launch = steps_launch({0, 9, 1}, {{1, 1, 0}, {2, 1, 0}, {3, 0, 0}});
    launch.regions.push_back(region(traces::ObjectKind::ray_state_write, 0x40000000, 16, 16, 1000));
    auto warp = std::make_shared<traces::WarpTrace>(*launch.warps[0]);
    warp->records[1].region = 1;
    launch.warps[0] = warp;
    const TimedStatistics t = timed(gpu, launch);
    CHECK(t.instructions == 3);
    CHECK(t.loads == 2);
    // The store issues in cycle 500, the load in 501; the sector that is written takes DRAM an eighth of a cycle more.
    CHECK(t.cycles == 501 + 500 + 1);
}

TEST_CASE("steps that wait for what is still to come are refused") {
    for (const Steps& wrong :
         {Steps{{0, 1, 0}, {2, 0, 0}}, Steps{{1, 0, 1}}, Steps{{3, 0, 0}}, Steps{{2, 0, 0}, {1, 0, 0}}})
        CHECK_THROWS_WITH(timed(steps_gpu(), steps_launch({0, 1}, wrong)),
                          Catch::Contains("launch 0, warp 0 of the trace"));
}
