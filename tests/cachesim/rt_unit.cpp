// Visits to nodes and triangles in the RT unit of an SM, by cycles counted by hand.
#include "cachesim/replay/timed/rt_unit.hpp"

#include <catch2/catch.hpp>
#include <initializer_list>

#include "cachesim/gpus/limits.hpp"
#include "timed_cases.hpp"

using namespace raycache;
using namespace raycache::cachesim;
using namespace raycache::cachesim::test;
using traces::ObjectKind;

namespace {

constexpr std::uint8_t nodes = 0, triangles = 1, texels = 2, wide_nodes = 3;

/// Nodes of two boxes and 64 B, triangles of 48 B, texels of 16 B, nodes of eight boxes and 80 B.
std::vector<traces::Region> regions() {
    std::vector<traces::Region> all{
        region(ObjectKind::node, 0x200000, 64, 64, 4096), region(ObjectKind::triangle, 0x400000, 48, 48, 4096),
        region(ObjectKind::texel, 0x600000, 16, 16, 4096), region(ObjectKind::node, 0x800000, 80, 80, 4096)};
    all[nodes].degree = 2;
    all[wide_nodes].degree = 8;
    return all;
}

/// One record: where lanes read, or begin a ray.
struct Access {
    std::uint8_t region;
    std::vector<std::uint32_t> elements;
};
const Access ray{traces::ray_start, {0}};

Launch launch_by(const std::vector<std::vector<Access>>& warps) {
    Launch launch{regions(), {}};
    for (const auto& accesses : warps) {
        auto warp = std::make_shared<traces::WarpTrace>();
        warp->warp = static_cast<std::uint32_t>(launch.warps.size());
        for (const Access& access : accesses) {
            traces::Record record;
            record.mask = static_cast<std::uint32_t>((std::uint64_t{1} << access.elements.size()) - 1);
            record.region = access.region;
            warp->records.push_back(record);
            if (record.is_access())
                warp->elements.insert(warp->elements.end(), access.elements.begin(), access.elements.end());
        }
        launch.warps.push_back(std::move(warp));
    }
    return launch;
}

/// Instructions of visits cost a lot, so that none can hide; 2 boxes or 1 triangle a cycle, results 10 or 20 later.
Gpu rt_gpu(unsigned warps = 1) {
    Gpu gpu = timed_gpu();
    gpu.warps_per_sm = gpu.warps_per_cta = warps;
    gpu.timing->node_instructions = gpu.timing->triangle_instructions = gpu.timing->leaf_instructions = 1000;
    gpu.traversal = Traversal::rt_unit;
    RtUnitTiming& unit = gpu.rt_unit.emplace();
    unit.box_tests_per_cycle = 2;
    unit.triangle_tests_per_cycle = 1;
    unit.box_latency = 10;
    unit.triangle_latency = 20;
    return gpu;
}

std::uint64_t cycles(const Gpu& gpu, const std::vector<std::vector<Access>>& warps) {
    return timed(gpu, launch_by(warps)).cycles;
}

/// Two loads of 32 B, a cycle apart, to DRAM and back.
constexpr std::uint64_t fetched = 500 + 1, found = 30 + 1;

}  // namespace

TEST_CASE("a visit in the RT unit takes its two loads, the tests of its lanes, and their latency") {
    const Gpu gpu = rt_gpu();
    // The only test of each of two boxes begins as the data are there.
    CHECK(cycles(gpu, {{{nodes, {7}}}}) == fetched + 10);
    // Five lanes: 10 tests, the last two begin four cycles later.
    CHECK(cycles(gpu, {{{nodes, {7, 7, 7, 7, 7}}}}) == fetched + 4 + 10);
    // Three lanes, a triangle each cycle.
    CHECK(cycles(gpu, {{{triangles, {0, 0, 0}}}}) == fetched + 2 + 20);
    // Eight boxes of one lane; 80 bytes are three loads.
    CHECK(cycles(gpu, {{{wide_nodes, {0}}}}) == fetched + 1 + 3 + 10);
    // A second visit begins when the results of the first are there, and finds its node in L1.
    CHECK(cycles(gpu, {{{nodes, {7}}, {nodes, {7}}}}) == fetched + 10 + found + 10);
}

TEST_CASE("tests of all warps share the pipeline of their kind, and the other kind has its own") {
    Gpu gpu = rt_gpu(2);
    gpu.rt_unit->box_tests_per_cycle = 0.5;
    gpu.rt_unit->triangle_tests_per_cycle = 0.25;
    const Access node{nodes, {0, 0}}, triangle{triangles, {0}};
    // 4 tests take 8 cycles: the last of them is the eighth.
    CHECK(cycles(gpu, {{node}}) == fetched + 7 + 10);
    // The second warp's data, two cycles behind the first's, find the pipeline taken until 8 cycles after the first.
    CHECK(cycles(gpu, {{node}, {{nodes, {16, 16}}}}) == fetched + 7 + 8 + 10);
    // Not by triangles: two cycles later, four for one test, 20 to its result.
    CHECK(cycles(gpu, {{node}, {triangle}}) == fetched + 2 + 3 + 20);
    const TimedStatistics t = timed(gpu, launch_by({{node}, {triangle}}));
    CHECK(t.rt_box_tests.busy == 8);
    CHECK(t.rt_triangle_tests.busy == 4);
    CHECK(t.rt_box_tests.copies == 1);
}

TEST_CASE("warps wait for a place in the warp buffer, in order, until the SM has something to do for one inside") {
    Gpu gpu = rt_gpu(3);
    gpu.rt_unit->warps = 1;
    const std::uint64_t visit = fetched + 10;
    CHECK(cycles(gpu, {{{nodes, {0}}}, {{nodes, {16}}}, {{nodes, {32}}}}) == 3 * visit);
    gpu.rt_unit->warps = 2;
    // The second's loads go behind the first's, two cycles later; the third gets the place of the first.
    CHECK(cycles(gpu, {{{nodes, {0}}}, {{nodes, {16}}}, {{nodes, {32}}}}) == 2 * visit);
    gpu.rt_unit->warps = 3;
    CHECK(cycles(gpu, {{{nodes, {0}}}, {{nodes, {16}}}, {{nodes, {32}}}}) == visit + 4);
    // A warp that visits again keeps its place: the other one waits for both visits.
    gpu.rt_unit->warps = 1;
    CHECK(cycles(gpu, {{{nodes, {0}}, {nodes, {0}}}, {{nodes, {16}}}}) == visit + found + 10 + visit);
}

TEST_CASE("shading takes instructions of the SM, and no place in the warp buffer meanwhile") {
    Gpu gpu = rt_gpu();
    gpu.timing->shading_instructions = 100;  // 4 chains of one instruction every 4 cycles
    const TimedStatistics t = timed(gpu, launch_by({{ray, {nodes, {7}}, ray, {nodes, {7}}}}));
    CHECK(t.cycles == 100 + (fetched + 10) + 100 + (found + 10));
    CHECK(t.rt_warps.busy == fetched + 10 + found + 10);
    CHECK(t.instructions == 200);
    CHECK(t.issue.busy == 200);
    // Another warp has the only place while the first is shaded.
    gpu.warps_per_sm = gpu.warps_per_cta = 2;
    gpu.rt_unit->warps = 1;
    CHECK(cycles(gpu, {{ray, {nodes, {7}}}, {{nodes, {7}}, {nodes, {7}}}}) ==
          std::uint64_t{fetched + 10 + found + 10 + found + 10});
}

TEST_CASE("no scheduler issues what the RT unit does, and texels are the SM's") {
    Gpu gpu = rt_gpu();
    gpu.timing->texel_instructions = 5;
    const TimedStatistics t = timed(gpu, launch_by({{{nodes, {0}}, {triangles, {0}}, {texels, {0}}}}));
    CHECK(t.rt_loads == 4);
    CHECK(t.loads == 1);
    CHECK(t.instructions == 6);
    CHECK(t.warp_accesses == 3);
    CHECK(t.levels[0].requests() == 2 + 2 + 1);
    CHECK(t.cycles == (fetched + 10) + (fetched + 20) + 500 + 5);
}

TEST_CASE("an object is as many loads as it has pieces, one a cycle") {
    const auto two_visits = [](std::uint32_t bytes) {
        Gpu gpu = rt_gpu();
        gpu.rt_unit->load_bytes = bytes;
        return timed(gpu, launch_by({{{nodes, {7}}, {nodes, {7}}}}));
    };
    // Four pieces: the third is the first of the second sector; in the second visit the fourth is found last.
    CHECK(two_visits(16).cycles == (500 + 2 + 10) + (30 + 3 + 10));
    CHECK(two_visits(16).rt_loads == 8);
    // One: both sectors at once, but one a cycle through the crossbar.
    CHECK(two_visits(64).cycles == (500 + 1 + 10) + (30 + 10));
    CHECK(two_visits(64).rt_loads == 2);
}

TEST_CASE("the unit fills the queues of several L1s faster with more loads a cycle") {
    Gpu gpu = rt_gpu(2);
    gpu.l1_per_sm = 2;  // of a warp each
    gpu.timing->crossbar_bytes_per_cycle = gpu.timing->l2_bytes_per_cycle = gpu.timing->dram_gb_s = 4096;
    const std::vector<std::vector<Access>> warps{{{nodes, {0}}}, {{nodes, {4}}}};  // and a slice
    CHECK(cycles(gpu, warps) == 500 + 3 + 10);  // four loads, the last in the fourth cycle
    gpu.rt_unit->loads_per_cycle = 4;
    CHECK(cycles(gpu, warps) < 500 + 3 + 10);
    CHECK(cycles(gpu, {warps[0]}) == 500 + 1 + 10);  // one port takes them one by one
}

TEST_CASE("loads of the SM wait behind those that stand in the unit's queue, and no others") {
    // Three warps gather 32 lines twice, at one line a cycle: 192 cycles of the port. After 100 of them a fourth asks
    // for a texel, and works long on it: behind the fifth of these loads where one may wait, behind all of them else.
    const auto ends = [](std::uint32_t queue) {
        Gpu gpu = rt_gpu(4);
        gpu.timing->tags_per_cycle = 1;
        gpu.timing->shading_instructions = 100;
        gpu.timing->texel_instructions = 5000;
        gpu.rt_unit->load_queue = queue;
        std::vector<std::vector<Access>> warps(3);
        for (std::uint32_t w = 0; w < 3; ++w) {
            warps[w].push_back({nodes, {}});
            for (std::uint32_t lane = 0; lane < 32; ++lane) warps[w][0].elements.push_back(2 * (32 * w + lane));
        }
        warps.push_back({ray, {texels, {0}}});
        return cycles(gpu, warps);
    };
    CHECK(static_cast<double>(ends(4) - ends(1)) == Approx(32).margin(8));
    CHECK(ends(4) == ends(64));
}

TEST_CASE("an RT unit of endless rates and no latency leaves memory alone: software without instructions") {
    for (const std::uint64_t seed : {1, 2, 3}) {
        Launch launch = random_launch(regions(), 40, 60, seed);
        Gpu software = cramped_gpu(8);
        software.warps_per_sm = software.warps_per_cta = 1;  // one warp at a time: no order to differ in
        Gpu unit = software;
        unit.traversal = Traversal::rt_unit;
        unit.rt_unit = RtUnitTiming{.warps = 1024,
                                    .box_tests_per_cycle = 1e6,
                                    .triangle_tests_per_cycle = 1e6,
                                    .box_latency = 0,
                                    .triangle_latency = 0,
                                    .load_bytes = 16};
        const TimedStatistics a = timed(software, launch), b = timed(unit, launch);
        CHECK(a.cycles == b.cycles);
        CHECK(a.levels == b.levels);
        CHECK(a.dram_sectors == b.dram_sectors);
        CHECK(a.loads == b.loads + b.rt_loads);
        // Idealised replays take the rates away, and with them nothing else.
        unit.rt_unit->box_tests_per_cycle = unit.rt_unit->triangle_tests_per_cycle = 0.01;
        Idealised ideal;
        ideal.infinite_bandwidth = true;
        CHECK(timed(unit, launch, ideal).cycles == timed(software, launch, ideal).cycles);
    }
}

TEST_CASE("more tests a cycle are never slower, and no launch is faster than its tests allow") {
    const Launch launch = random_launch(regions(), 60, 80, 7);
    std::uint64_t boxes = 0, tests_of_triangles = 0;
    for (const auto& warp : launch.warps)
        for (const traces::Record& record : warp->records) {
            if (record.region == nodes) boxes += 2 * record.lanes();
            if (record.region == wide_nodes) boxes += 8 * record.lanes();
            if (record.region == triangles) tests_of_triangles += record.lanes();
        }
    Gpu gpu = rt_gpu(8);
    gpu.rt_unit->warps = 8;
    std::uint64_t before = never;
    for (const double rate : {0.25, 0.5, 1.0, 2.0, 5.5, 16.0, 1e6}) {
        gpu.rt_unit->box_tests_per_cycle = gpu.rt_unit->triangle_tests_per_cycle = rate;
        const TimedStatistics t = timed(gpu, launch);
        CAPTURE(rate, t.cycles, before);
        CHECK(static_cast<double>(t.cycles) <= 1.01 * static_cast<double>(before));
        CHECK(static_cast<double>(t.cycles) * rate >= static_cast<double>(boxes));
        CHECK(t.rt_box_tests.busy == Approx(static_cast<double>(boxes) / rate));
        CHECK(t.rt_triangle_tests.busy == Approx(static_cast<double>(tests_of_triangles) / rate));
        before = t.cycles;
    }
    gpu.rt_unit->box_tests_per_cycle = 0.25;
    const TimedStatistics slow = timed(gpu, launch);
    CHECK(slow.rt_box_tests.busy > 0.5 * static_cast<double>(slow.cycles));  // what binds, but where CTAs end
}

TEST_CASE("loads of the RT unit pass the port with the same results on the fast path and by the rule") {
    for (const std::uint32_t bytes : {16u, 32u, 64u, 128u}) {
        Gpu gpu = cramped_gpu(16);
        gpu.traversal = Traversal::rt_unit;
        gpu.rt_unit = RtUnitTiming{.warps = 2, .load_bytes = bytes};
        const Launch launch = random_launch(regions(), 30, 60, bytes);
        const TimedStatistics fast = timed(gpu, launch), rule = timed(gpu, launch, {}, PortPath::rule);
        CHECK(fast.cycles == rule.cycles);
        CHECK(fast.levels == rule.levels);
        CHECK(fast.rt_loads == rule.rt_loads);
    }
}

TEST_CASE("an RT unit that software leaves idle changes nothing") {
    const Launch launch = random_launch(regions(), 40, 60, 5);
    Gpu without = cramped_gpu(8);
    without.timing->node_instructions = 7;
    Gpu with = without;
    with.rt_unit.emplace();
    const TimedStatistics a = timed(without, launch), b = timed(with, launch);
    CHECK(a.cycles == b.cycles);
    CHECK(a.levels == b.levels);
    CHECK(a.instructions == b.instructions);
    CHECK(b.rt_loads == 0);
    CHECK(b.rt_warps.busy == 0);
}

TEST_CASE("traversal by an RT unit needs one, and no collectors or several visits of a warp at once") {
    const auto message = [](const Gpu& gpu) {
        const auto problem = find_problem(gpu);
        return problem ? problem->key + ": " + problem->message : std::string();
    };
    Gpu gpu = rt_gpu();
    CHECK(message(gpu).empty());
    gpu.rt_unit->box_tests_per_cycle = 1e7;
    CHECK_THAT(message(gpu), Catch::StartsWith("rt_unit.box_tests_per_cycle: expected 0.001 to 1000000, found"));
    gpu.rt_unit.reset();
    CHECK_THAT(message(gpu), Catch::StartsWith("traversal: expected a table [rt_unit] for \"rt_unit\", found none"));
    gpu = rt_gpu();
    gpu.timing->operand_collectors = 4;
    CHECK_THAT(message(gpu), Catch::StartsWith("traversal: expected \"software\" with operand_collectors"));
    gpu = rt_gpu();
    gpu.timing->accesses_in_flight = 2;
    CHECK_THAT(message(gpu), Catch::Contains("found \"rt_unit\" with 0 and 2"));
}
