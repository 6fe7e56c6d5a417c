// Counts of windows, scaled to the work that tracing alone finds: by hand.
#include "tools/jobs/windows/work_count.hpp"

#include <catch2/catch.hpp>

using namespace raycache;
using namespace raycache::tools;
using cachesim::Counters;
using traces::ObjectKind;
using traces::RayType;

namespace {

std::vector<traces::Region> regions() {
    traces::Region nodes, texels;
    nodes.kind = ObjectKind::node;
    texels.kind = ObjectKind::texel;
    return {nodes, texels};
}

constexpr std::size_t node = static_cast<std::size_t>(ObjectKind::node);
constexpr std::size_t texel = static_cast<std::size_t>(ObjectKind::texel);

cachesim::Gpu two_levels() {
    cachesim::Gpu gpu;
    gpu.levels.resize(2);
    return gpu;
}

/// A camera ray of four lanes that reads three nodes and, with two lanes, a texel; a bounce of two that reads a node.
traces::WarpTrace warp() {
    traces::WarpTrace trace;
    trace.records.push_back({0b1111, traces::ray_start, RayType::camera, 0, 0});
    trace.records.push_back({0b1111, 0, RayType::camera, 0, 0});
    trace.records.push_back({0b1111, 0, RayType::camera, 0, 0});
    trace.records.push_back({0b0001, 0, RayType::camera, 0, 0});
    trace.records.push_back({0b1001, 1, RayType::camera, 0, 0});
    trace.records.push_back({0b0011, traces::ray_start, RayType::bounce, 1, 0});
    trace.records.push_back({0b0011, 0, RayType::bounce, 1, 0});
    return trace;
}

Counters counted(std::uint64_t warp_accesses, std::uint64_t l1, std::uint64_t l2, std::uint64_t l2_missed) {
    Counters c;
    c.warp_accesses = warp_accesses;
    c.lane_accesses = 2 * warp_accesses;
    c.loads = 4 * warp_accesses;
    c.requests = 8 * warp_accesses;
    c.levels[0] = {l1, l1 - l2};
    c.levels[1] = {l2, l2 - l2_missed};
    c.dram_sectors = l2_missed + 1;
    return c;
}

/// Nodes read by camera rays.
cachesim::LaunchStatistics of_camera_nodes(const Counters& c) {
    cachesim::LaunchStatistics all;
    cachesim::RayGroup group;
    group.by_kind[node] = c;
    all.groups.push_back(group);
    return all;
}

}  // namespace

TEST_CASE("work is rays and accesses by ray, bounce and kind, times the scale") {
    WorkCount work(regions(), {});
    work.add(warp());
    work.add(warp());
    CHECK(work.rays() == 12);
    const auto groups = work.launch({}, {}, two_levels(), 5);
    REQUIRE(groups.size() == 2);
    CHECK(groups[0].ray == RayType::camera);
    CHECK(groups[0].rays == 40);
    CHECK(groups[0].by_kind[node].warp_accesses == 30);
    CHECK(groups[0].by_kind[node].lane_accesses == 90);
    CHECK(groups[0].by_kind[node].steps == 90);
    CHECK(groups[0].by_kind[texel].warp_accesses == 10);
    CHECK(groups[0].by_kind[texel].lane_accesses == 20);
    CHECK(groups[0].by_kind[texel].steps == 0);
    CHECK(groups[1].ray == RayType::bounce);
    CHECK(groups[1].bounce == 1);
    CHECK(groups[1].rays == 20);
    CHECK(groups[1].by_kind[node].warp_accesses == 10);
    CHECK(groups[0].by_kind[node].levels[0].sectors == 0);  // no window met it
}

TEST_CASE("narrower vectors are counted as those that have an active lane") {
    WorkCount work(regions(), {2});
    work.add(warp());
    cachesim::Gpu cpu = two_levels();
    cpu.simd_width = 2;
    const auto groups = work.launch({}, {}, cpu, 1);
    CHECK(groups[0].by_kind[node].warp_accesses == 2 + 2 + 1);
    CHECK(groups[0].by_kind[texel].warp_accesses == 2);
    CHECK(groups[1].by_kind[node].warp_accesses == 1);
}

TEST_CASE("counts of windows of an SM are scaled to the accesses that the work has") {
    WorkCount work(regions(), {});
    work.add(warp());
    // The work, 3 accesses times 20, is twice that of the windows.
    const auto groups = work.launch(of_camera_nodes(counted(30, 90, 30, 7)), {}, two_levels(), 20);
    const Counters& nodes = groups[0].by_kind[node];
    CHECK(nodes.warp_accesses == 60);
    CHECK(nodes.loads == 240);
    CHECK(nodes.requests == 480);
    CHECK(nodes.levels[0].sectors == 180);
    CHECK(nodes.levels[0].hits == 120);
    CHECK(nodes.levels[1].sectors == 60);
    // A bounce's nodes were in no window: charged as nodes are on average, a third of the accesses.
    CHECK(groups[1].by_kind[node].levels[0].sectors == 60);
    CHECK(groups[1].by_kind[node].levels[1].sectors == 20);
    // Texels were in no window at all.
    CHECK(groups[0].by_kind[texel].warp_accesses == 20);
    CHECK(groups[0].by_kind[texel].levels[0].sectors == 0);
}

TEST_CASE("the last cache misses half of what windows miss, and half of their miss rate of what SMs ask of it") {
    WorkCount work(regions(), {});
    work.add(warp());
    // Scaled to 60 accesses, SMs ask for 60 sectors; windows ask for 240, of which 40 miss, and 44 come from DRAM. At
    // their miss rate SMs would miss 10, and 11 would come from DRAM.
    const auto groups = work.launch(of_camera_nodes(counted(30, 90, 30, 7)), of_camera_nodes(counted(15, 90, 60, 10)),
                                    two_levels(), 20);
    const Counters& nodes = groups[0].by_kind[node];
    CHECK(nodes.levels[1].sectors == 60);
    CHECK(nodes.levels[1].hits == 60 - (40 + 10) / 2);
    CHECK(nodes.dram_sectors == 28);  // 27.5
}

TEST_CASE("time is scaled to the warp accesses of the work, and its rays are those of the work") {
    WorkCount work(regions(), {});
    work.add(warp());
    cachesim::TimedStatistics times;
    times.cycles = 1000;
    times.warp_accesses = 200;
    times.rays = 77;
    work.scale(times, 20);  // 5 accesses, so 100
    CHECK(times.warp_accesses == 100);
    CHECK(times.cycles == 500);
    CHECK(times.rays == 120);
    cachesim::TimedStatistics none;
    work.scale(none, 20);
    CHECK(none.rays == 0);
}
