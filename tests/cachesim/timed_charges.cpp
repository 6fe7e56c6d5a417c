// What a visit costs beside its look-ups: instructions where a leaf begins, and groups of lanes that ask for nothing.
#include <catch2/catch.hpp>

#include "timed_cases.hpp"

using namespace raycache;
using namespace raycache::cachesim;
using namespace raycache::cachesim::test;
using traces::ObjectKind;

namespace {

/// Region 0: 4 nodes, 1: 8 triangles, 2: 4 texels, all of 16 bytes, one load each. `linked`: nodes lead to the
/// triangles 0, 2, 3 and 7, so leaves are 0 1, 2, 3 to 6, and 7.
std::vector<traces::Region> small_tree(bool linked) {
    std::vector<traces::Region> regions{region(ObjectKind::node, 0x200000, 16, 16, 4),
                                        region(ObjectKind::triangle, 0x400000, 16, 16, 8),
                                        region(ObjectKind::texel, 0x600000, 16, 16, 4)};
    if (linked) {
        const auto triangle = [](std::uint32_t t) { return 1u << 30 | t; };
        regions[0].degree = 2;
        regions[0].links = {1, 2, triangle(0), triangle(2), triangle(3), 3, triangle(7), traces::no_link};
    }
    return regions;
}

struct Access {
    std::uint8_t region;
    std::vector<std::uint32_t> elements;
};
constexpr std::uint8_t nodes = 0, triangles = 1, texels = 2;

Launch one_warp(bool linked, const std::vector<Access>& accesses) {
    auto warp = std::make_shared<traces::WarpTrace>();
    for (const Access& access : accesses) {
        traces::Record record;
        record.mask = static_cast<std::uint32_t>((std::uint64_t{1} << access.elements.size()) - 1);
        record.region = access.region;
        warp->records.push_back(record);
        warp->elements.insert(warp->elements.end(), access.elements.begin(), access.elements.end());
    }
    return {small_tree(linked), {warp}};
}

/// Instructions that the launch takes beside its loads; nodes, triangles and texels cost none.
std::uint64_t instructions(const Launch& launch, const Gpu& gpu, const Idealised& ideal = {}) {
    const TimedStatistics t = timed(gpu, launch, ideal);
    return t.instructions - t.loads;
}

Gpu leaf_gpu() {
    Gpu gpu = timed_gpu();
    gpu.timing->leaf_instructions = 100;
    return gpu;
}

Gpu pairs_gpu(std::uint32_t empty_request_cycles) {
    Gpu gpu = timed_gpu();
    gpu.front_end.lanes_per_request_16 = 2;
    gpu.timing->empty_request_cycles = empty_request_cycles;
    gpu.timing->l1_mshr_merges = 16;  // all pairs of a warp may wait for one sector
    return gpu;
}

/// All lanes of the mask read the same element, `times` times.
Launch broadcast(std::uint32_t mask, unsigned times = 1) {
    auto warp = std::make_shared<traces::WarpTrace>();
    traces::Record record;
    record.mask = mask;
    warp->records.assign(times, record);
    warp->elements.assign(std::size_t{record.lanes()} * times, 0);
    return {pieces, {warp}};
}

}  // namespace

TEST_CASE("a leaf costs its instructions once, where a lane reads a triangle that a node links to") {
    const Gpu gpu = leaf_gpu();
    CHECK(instructions(one_warp(true, {{nodes, {0}}, {triangles, {0}}, {triangles, {1}}}), gpu) == 100);
    CHECK(instructions(one_warp(true, {{triangles, {3}}, {triangles, {4}}, {triangles, {5}}, {triangles, {6}}}), gpu) ==
          100);
    // From one leaf to the next without a node between them, although the triangles follow each other.
    CHECK(instructions(one_warp(true, {{triangles, {0}}, {triangles, {1}}, {triangles, {2}}, {triangles, {3}}}), gpu) ==
          300);
    // The same leaf again; a texel between triangles of a leaf; a leaf left early.
    CHECK(instructions(one_warp(true, {{triangles, {7}}, {nodes, {1}}, {triangles, {7}}}), gpu) == 200);
    CHECK(instructions(one_warp(true, {{triangles, {3}}, {texels, {0}}, {triangles, {4}}}), gpu) == 100);
    CHECK(instructions(one_warp(true, {{nodes, {0}}, {nodes, {1}}, {texels, {0}}}), gpu) == 0);
}

TEST_CASE("lanes that begin leaves together pay once, as instructions of a warp do") {
    const Gpu gpu = leaf_gpu();
    CHECK(instructions(one_warp(true, {{triangles, {0, 2, 3, 7}}, {triangles, {1, 4}}, {triangles, {5}}}), gpu) == 100);
    // One lane that begins is enough.
    CHECK(instructions(one_warp(true, {{triangles, {4, 1, 7}}}), gpu) == 100);
    CHECK(instructions(one_warp(true, {{triangles, {4, 1, 6}}}), gpu) == 0);
}

TEST_CASE("vectors of a machine of fewer lanes pay for the leaves that their own lanes begin") {
    Gpu gpu = leaf_gpu();
    gpu.simd_width = 2;
    CHECK(instructions(one_warp(true, {{triangles, {0, 1, 4, 5, 6, 7}}}), gpu) == 200);
    CHECK(instructions(one_warp(false, {{nodes, {0}}, {triangles, {0, 1, 4, 5, 6, 7}}, {triangles, {1}}}), gpu) == 300);
}

TEST_CASE("where no link leads to a triangle a leaf begins behind an access to something else, texels aside") {
    const Gpu gpu = leaf_gpu();
    CHECK(instructions(one_warp(false, {{triangles, {4}}, {triangles, {5}}, {triangles, {1}}}), gpu) == 100);
    CHECK(instructions(one_warp(false, {{triangles, {4}}, {nodes, {1}}, {triangles, {5}}}), gpu) == 200);
    CHECK(instructions(one_warp(false, {{triangles, {4}}, {texels, {1}}, {triangles, {5}}}), gpu) == 100);
    Launch rays = one_warp(false, {{triangles, {4}}, {triangles, {5}}});
    auto warp = std::make_shared<traces::WarpTrace>(*rays.warps[0]);
    traces::Record start;
    start.mask = 1;
    start.region = traces::ray_start;
    warp->records.insert(warp->records.begin() + 1, start);
    rays.warps = {warp};
    CHECK(instructions(rays, gpu) == 200);
}

TEST_CASE("a leaf's instructions follow the data of its first triangle, and delay the next visit") {
    Gpu gpu = leaf_gpu();
    gpu.timing->dependent_chains = 1;
    gpu.timing->instruction_latency = 5;
    gpu.timing->triangle_instructions = 3;
    // Data of triangle 0: 500 cycles. 103 instructions, one every 5 cycles, the last begins 510 later; then a hit of
    // 30 cycles (its load the cycle after), and 3 more.
    const auto cycles = [&] { return timed(gpu, one_warp(true, {{triangles, {0}}, {triangles, {1}}})).cycles; };
    CHECK(cycles() == 500 + (102 * 5 + 1) + 30 + (2 * 5 + 1));
    gpu.timing->leaf_instructions = 0;
    CHECK(cycles() == 500 + (2 * 5 + 1) + 30 + (2 * 5 + 1));
    // One by one through collectors it is the same count.
    gpu.timing->leaf_instructions = 100;
    gpu.timing->operand_collectors = 4;
    CHECK(instructions(one_warp(true, {{triangles, {0}}, {triangles, {1}}}), gpu) == 106);
}

TEST_CASE("groups of lanes without an active one pass the port for nothing, or take the cycles that the GPU says") {
    struct Case {
        std::uint32_t mask;
        unsigned groups, before, behind;  // with lanes; empty ones before the first of them, and behind the last
    };
    for (const Case& c : {Case{0x1, 1, 0, 15}, Case{0x10, 1, 2, 13}, Case{0x80000001, 2, 0, 0}, Case{0xc, 1, 1, 14},
                          Case{0x01100110, 4, 2, 3}, Case{0xffffffff, 16, 0, 0}}) {
        CAPTURE(c.mask);
        for (const std::uint32_t empty : {0u, 1u, 3u}) {
            const TimedStatistics t = timed(pairs_gpu(empty), broadcast(c.mask));
            CHECK(t.l1_port.busy == c.groups + empty * (16 - c.groups));
            // The last group with lanes asks last, and finds the first one's sector on its way; data 500 cycles after
            // the first asked, or those of a hit after the last.
            CHECK(t.cycles == 500 + empty * c.before);
            CHECK(t.levels[0].requests() == c.groups);
        }
    }
}

TEST_CASE("empty groups hold up the loads behind them, across the windows of a replay") {
    const auto cycles = [](std::uint32_t mask, std::uint32_t empty, unsigned warps) {
        Gpu gpu = pairs_gpu(empty);
        gpu.warps_per_sm = gpu.warps_per_cta = 16;
        Launch launch = broadcast(mask, 200);
        launch.warps.assign(warps, launch.warps[0]);
        return timed(gpu, launch).cycles;
    };
    // 16 warps of 200 loads, each 1 cycle or 16 of the port, which is the limit.
    CHECK(static_cast<double>(cycles(0x100, 1, 16)) == Approx(16 * 200 * 16 + 500).epsilon(0.02));
    CHECK(static_cast<double>(cycles(0x100, 7, 16)) == Approx(16 * 200 * (1 + 15 * 7) + 500).epsilon(0.02));
    CHECK(cycles(0x100, 0, 16) < 8000);
    // No group is empty: nothing changes.
    CHECK(cycles(0x55555555, 1, 16) == cycles(0x55555555, 0, 16));
}

TEST_CASE("where a whole warp, or a vector, goes at once there is no empty group") {
    Gpu gpu = timed_gpu();
    gpu.timing->empty_request_cycles = 9;
    CHECK(timed(gpu, broadcast(0x10)).l1_port.busy == 1);
    Gpu vectors = pairs_gpu(1);
    vectors.simd_width = 4;  // two vectors have lanes, each of two groups
    CHECK(timed(vectors, broadcast(0x01000001)).l1_port.busy == 4);
    Idealised ideal;
    ideal.infinite_bandwidth = true;
    CHECK(timed(pairs_gpu(5), broadcast(0x10), ideal).cycles == timed(pairs_gpu(0), broadcast(0x10), ideal).cycles);
}

TEST_CASE("functional requests do not depend on what empty groups take") {
    const Launch launch = random_launch({region(ObjectKind::node, 0x200000, 64, 64, 200)}, 20, 50, 3);
    const TimedStatistics free = timed(pairs_gpu(0), launch), taken = timed(pairs_gpu(2), launch);
    CHECK(free.levels[0].requests() == taken.levels[0].requests());
    CHECK(free.loads == taken.loads);
    CHECK(free.cycles < taken.cycles);
}
