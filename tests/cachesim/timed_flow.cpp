// Instructions one by one through operand collectors.
#include <catch2/catch.hpp>

#include "cachesim/replay/timed/instruction_flow.hpp"
#include "timed_cases.hpp"

using namespace raycache;
using namespace raycache::cachesim;
using namespace raycache::cachesim::test;

namespace {

constexpr auto arithmetic = OperandCollectors::arithmetic, load = OperandCollectors::load;

Gpu flow_gpu() {
    Gpu gpu = timed_gpu();
    gpu.timing->operand_collectors = 2;
    gpu.timing->node_instructions = 10;
    gpu.timing->instruction_latency = 7;
    gpu.timing->dependent_chains = 4;
    return gpu;
}

}  // namespace

TEST_CASE("an instruction is in its first register one cycle, in a collector the next, then before its unit") {
    OperandCollectors c(2, 2);
    CHECK(c.takes(0, load));
    c.issue(0, 5, 1, load);
    CHECK_FALSE(c.takes(0, load));
    CHECK(c.takes(0, arithmetic));
    CHECK(c.takes(1, load));
    CHECK(c.advance());
    CHECK(c.takes(0, load));
    CHECK(c.collected(load) == 0);
    CHECK(c.advance());
    CHECK(c.collected(load) == 1);
    CHECK(c.collected(0, load).flight == 5);
    CHECK(c.take(0, load).number == 1);
    CHECK(c.empty());
    CHECK_FALSE(c.advance());
}

TEST_CASE("the oldest instruction of a kind that finds no collector holds up those of other schedulers") {
    OperandCollectors c(2, 1);
    c.issue(0, 1, 0, arithmetic);
    c.advance();  // in the collector of scheduler 0
    c.issue(0, 2, 0, arithmetic);
    c.advance();  // the first before its unit, the second in the collector
    c.issue(0, 3, 0, arithmetic);
    c.issue(1, 4, 0, arithmetic);
    c.issue(1, 5, 0, load);
    CHECK(c.advance());  // the load alone: 4 is younger than 3, which waits
    CHECK_FALSE(c.takes(1, arithmetic));
    CHECK(c.takes(1, load));
    CHECK_FALSE(c.takes(0, arithmetic));
    CHECK(c.take(0, arithmetic).flight == 1);
    CHECK(c.advance());  // 2 leaves its collector, 3 enters, then 4
    CHECK(c.takes(0, arithmetic));
    CHECK(c.takes(1, arithmetic));
    CHECK(c.collected(load) == 2);
}

TEST_CASE("a visit takes its load's latency, and its instructions four at a time") {
    // Ten instructions in four chains of latency 7 issue at 0 1 2 3, 7 8 9 10, 14 15 after the data; then the next
    // load.
    const Gpu gpu = flow_gpu();
    CHECK(timed(gpu, launch_of({chase(std::vector<std::uint32_t>(100, 0))})).cycles == 500 + 15 + 99 * (1 + 30 + 15));
    Gpu slow = gpu;
    slow.timing->instruction_interval = 3;  // each waits for the unit: 0 3 6 9 …, four of them to the next of a chain
    const auto cycles = [&](std::size_t visits) {
        return timed(slow, launch_of({chase(std::vector<std::uint32_t>(visits, 0))})).cycles;
    };
    CHECK(cycles(60) - cycles(50) > 10 * (1 + 30 + 15));
}

TEST_CASE("slow arithmetic takes collectors away from loads") {
    Gpu gpu = flow_gpu();
    gpu.warps_per_sm = gpu.warps_per_cta = 32;
    gpu.timing->schedulers = 4;
    gpu.timing->instruction_interval = 2;
    const Launch launch = random_launch({region(traces::ObjectKind::node, 0x200000, 64, 64, 2000)}, 64, 60, 3);
    const TimedStatistics shared = timed(gpu, launch);
    gpu.timing->operand_collectors = 16;
    const TimedStatistics many = timed(gpu, launch);
    CHECK(many.cycles < shared.cycles);
    for (const TimedStatistics& t : {shared, many}) {
        CHECK(t.lane_accesses == launch.lane_accesses());
        CHECK(t.instructions == t.warp_accesses * 10 + t.loads);
        CHECK(t.loads == t.warp_accesses * 4);
        CHECK(t.levels[1].requests() == t.levels[0].misses());
    }
}

TEST_CASE("with collectors all warps end, whatever is scarce") {
    for (const std::uint64_t ways : {1, 2, 3}) {
        for (const std::uint32_t collectors : {1u, 2u}) {
            Gpu gpu = cramped_gpu(ways);
            gpu.timing->operand_collectors = collectors;
            gpu.timing->node_instructions = ways == 2 ? 0 : 3;
            gpu.timing->shading_instructions = 5;
            gpu.timing->accesses_in_flight = 2;
            const Launch launch =
                random_launch({region(traces::ObjectKind::node, 0x200000, 64, 64, 300)}, 12, 20, ways);
            const TimedStatistics t = timed(gpu, launch);
            CHECK(t.lane_accesses == launch.lane_accesses());
            CHECK(t.levels[1].requests() == t.levels[0].misses());
            CHECK(t.visit_cycles >= t.warp_accesses * 30);
        }
    }
}
