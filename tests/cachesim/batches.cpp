// What a functional replay counts between "count from here" and "count until here".
#include <catch2/catch.hpp>
#include <memory>
#include <vector>

#include "cachesim/analysis/explainer.hpp"
#include "cachesim/replay/replay.hpp"
#include "oracle.hpp"
#include "random_launch.hpp"

using namespace raycache;
using namespace raycache::cachesim;
using namespace raycache::cachesim::test;
using traces::ObjectKind;

namespace {

/// Two to a line of 128 bytes, two sectors each.
const std::vector<traces::Region> nodes{region(ObjectKind::node, 0x200000, 64, 64, 5000)};

/// Lane 0 reads these elements one after the other.
std::shared_ptr<const traces::WarpTrace> chase(const std::vector<std::uint32_t>& elements) {
    auto warp = std::make_shared<traces::WarpTrace>();
    for (const std::uint32_t e : elements) {
        warp->records.push_back({1u, 0, traces::RayType::camera, 0, 0});
        warp->elements.push_back(e);
    }
    return warp;
}

/// One SM; an L1 of eight lines.
Gpu one_sm(unsigned warps) {
    Gpu gpu = small_gpu();
    gpu.sms = 1;
    gpu.warps_per_sm = warps;
    gpu.warps_per_cta = 1;
    return gpu;
}

Counters sum(const std::vector<LaunchStatistics>& batches) {
    Counters all;
    for (const LaunchStatistics& batch : batches) all += batch.all();
    return all;
}

}  // namespace

TEST_CASE("counts of consecutive batches add up to those of all warps") {
    const Launch launch = random_launch(nodes, 60, 40, 21);
    const LaunchStatistics whole = replay(small_gpu(), launch, 3);
    for (const std::size_t every : {1u, 2u, 7u, 30u, 60u}) {  // CTAs are of two warps
        Replay parts(small_gpu(), launch.regions, 3);
        for (std::size_t w = 0; w < launch.warps.size(); ++w) {
            if (w % every == 0) parts.count_from_here();
            parts.push(launch.warps[w]);
        }
        CAPTURE(every);
        CHECK(parts.finish() == whole);
        CHECK(parts.batches().size() == (60 + every - 1) / every);
        CHECK(sum(parts.batches()) == whole.all());
    }
}

TEST_CASE("a batch counts what its warps do, with caches that warps before it warmed") {
    Replay replay(one_sm(1), nodes, 0);
    replay.count_until_here();
    replay.push(chase({0, 8, 16}));
    replay.count_from_here();
    replay.push(chase({0, 4, 8}));  // 4 is new
    replay.count_until_here();
    replay.push(chase({4, 0, 400}));
    Counters expected;
    expected.steps = expected.lane_accesses = expected.warp_accesses = 3;
    expected.loads = expected.requests = 12;
    expected.levels[0].sectors = 6;
    expected.levels[0].hits = 4;
    expected.levels[1].sectors = expected.dram_sectors = expected.dram_first_sectors = 2;
    CHECK(replay.finish().all() == expected);
    REQUIRE(replay.batches().size() == 1);
    CHECK(replay.batches()[0].all() == expected);
}

TEST_CASE("warps of a batch and others that run at the same time are told apart") {
    // Turns: 0 of the first, 0 of the second, 100 of the first, 100 of the second: the second always hits.
    for (const bool second : {false, true}) {
        Replay replay(one_sm(2), nodes, 0);
        if (second) replay.count_until_here();
        replay.push(chase({0, 100}));
        second ? replay.count_from_here() : replay.count_until_here();
        replay.push(chase({0, 100}));
        const Counters c = replay.finish().all();
        CHECK(c.levels[0].sectors == 4);
        CHECK(c.levels[0].hits == (second ? 4 : 0));
        CHECK(c.dram_sectors == (second ? 0 : 4));
    }
}

TEST_CASE("a batch may span kernels, and one of no warp is none") {
    Replay replay(one_sm(1), nodes, 0);
    replay.count_from_here();
    replay.count_from_here();
    replay.push(chase({0}));
    replay.end_kernel();
    replay.push(chase({0}));
    replay.count_from_here();
    replay.count_until_here();
    replay.push(chase({0}));
    replay.count_from_here();
    const Counters all = replay.finish().all();
    CHECK(all.levels[0].sectors == 4);
    CHECK(all.levels[0].hits == 0);  // empty for the second kernel
    CHECK(all.levels[1].hits == 2);
    REQUIRE(replay.batches().size() == 1);
    CHECK(replay.batches()[0].all() == all);
}

TEST_CASE("rays are counted in the batch of their warp, whether it has accesses or not") {
    const auto start = [](std::uint32_t mask) {
        auto warp = std::make_shared<traces::WarpTrace>();
        warp->records.push_back({mask, traces::ray_start, traces::RayType::camera, 0, 0});
        return warp;
    };
    Replay replay(one_sm(1), nodes, 0);
    replay.push(start(0x7));
    replay.count_from_here();
    replay.push(start(0x1));
    replay.count_until_here();
    replay.push(start(0xff));
    CHECK(replay.finish().all().rays == 4);
    REQUIRE(replay.batches().size() == 2);
    CHECK(replay.batches()[0].all().rays == 3);
    CHECK(replay.batches()[1].all().rays == 1);
}

TEST_CASE("an explanation holds what its replay counts and nothing else, with caches as warm") {
    const Launch launch = random_launch(nodes, 60, 40, 22);
    const ElementDepth depth(launch.regions);
    Explainer explainer(small_gpu(), launch.regions, depth);
    Replay replay(small_gpu(), launch.regions, 0);
    replay.observe(explainer);
    for (std::size_t w = 0; w < launch.warps.size(); ++w) {
        if (w == 0) replay.count_until_here();
        if (w == 20) replay.count_from_here();
        if (w == 40) replay.count_until_here();
        replay.push(launch.warps[w]);
    }
    const Counters c = replay.finish().all();
    const MissCounts l1 = explainer.findings().levels[0].all(), l2 = explainer.findings().levels[1].all();
    CHECK(c.levels[0].sectors > 100);
    CHECK(l1.lookups == c.levels[0].sectors);
    CHECK(l1.misses() == c.levels[0].sectors - c.levels[0].hits);
    CHECK(l2.lookups == c.levels[1].sectors);
    CHECK(l2.compulsory == c.dram_first_sectors);
    CHECK(explainer.findings().sharing.same_warp + explainer.findings().sharing.same_cta +
              explainer.findings().sharing.other_cta ==
          c.levels[0].hits);
}
