#include "cachesim/replay/replay.hpp"

#include <catch2/catch.hpp>
#include <random>

#include "oracle.hpp"
#include "random_launch.hpp"
#include "traces/error.hpp"

using namespace raycache;
using namespace raycache::cachesim;
using namespace raycache::cachesim::test;
using traces::ObjectKind;

namespace {

const std::vector<traces::Region> nodes{region(ObjectKind::node, 0x200000, 64, 64, 1000)};

/// One warp; each inner list is one access, lanes from 0 up.
std::shared_ptr<traces::WarpTrace> warp(const std::vector<std::vector<std::uint32_t>>& accesses) {
    auto w = std::make_shared<traces::WarpTrace>();
    for (const auto& elements : accesses) {
        traces::Record record;
        record.mask = static_cast<std::uint32_t>((std::uint64_t{1} << elements.size()) - 1);
        w->records.push_back(record);
        w->elements.insert(w->elements.end(), elements.begin(), elements.end());
    }
    return w;
}

Gpu one_warp_at_a_time() {
    Gpu gpu = small_gpu();
    gpu.sms = 1;
    gpu.warps_per_sm = gpu.warps_per_cta = 1;
    return gpu;
}

}  // namespace

TEST_CASE("a tiny launch counts as computed by hand") {
    Gpu gpu = one_warp_at_a_time();
    gpu.levels[0].sets = gpu.levels[0].ways = 1;
    gpu.levels[1].sets = 1;
    gpu.levels[1].ways = 2;
    // Line 0 sectors 0, 1: DRAM. Line 0 sectors 2, 3: DRAM. Node 0 again: L1. Line 1: DRAM, evicts line 0 from L1.
    // Line 0, all four sectors: L1 miss, L2 hit.
    auto w = warp({{0}, {1}, {0}, {2}, {0, 1}});
    traces::Record start;
    start.mask = 0xf;
    start.region = traces::ray_start;
    w->records.insert(w->records.begin(), start);
    const LaunchStatistics s = replay(gpu, {nodes, {w}}, 3);
    CHECK(s.sample == 3);
    REQUIRE(s.groups.size() == 1);
    CHECK(s.groups[0].rays == 4);
    Counters expected;
    expected.steps = expected.lane_accesses = 6;
    expected.warp_accesses = 5;
    expected.loads = 5 * 4;     // of 16 B
    expected.requests = 6 * 4;  // no two lanes share a sector
    expected.levels[0].sectors = 12;
    expected.levels[0].hits = 2;
    expected.levels[1].sectors = 10;
    expected.levels[1].hits = 4;
    expected.dram_sectors = 6;
    expected.dram_first_sectors = 6;
    CHECK(s.groups[0].by_kind[0] == expected);
    expected.rays = 4;
    CHECK(s.all() == expected);
}

TEST_CASE("a tiny launch fills empty ways of the last level as computed by hand") {
    Gpu gpu = one_warp_at_a_time();
    gpu.levels[0].sets = gpu.levels[0].ways = 1;
    gpu.levels[1].sets = 1;
    gpu.levels[1].ways = 2;
    Replay replay(gpu, nodes, 0);
    replay.count_until_here();  // counted or not is the same
    // Lines 0, 0 (a sector miss), 1, 0 (hits in L2), 2, 1, 0: of five line misses two find an empty way.
    replay.push(warp({{0}, {1}, {2}, {0}, {4}, {2}, {0}}));
    CHECK(replay.last_level_fills() == LineFills{});  // nothing has run
    replay.finish();
    CHECK(replay.last_level_fills() == LineFills{5, 2});
}

TEST_CASE("warps of an SM take turns") {
    // With one line of L1, A A B B would hit twice; taking turns, A B A B never does.
    Gpu gpu = one_warp_at_a_time();
    gpu.warps_per_sm = gpu.warps_per_cta = 2;
    gpu.levels[0].sets = gpu.levels[0].ways = 1;
    CHECK(replay(gpu, {nodes, {warp({{0}, {0}}), warp({{2}, {2}})}}).all().levels[0].hits == 0);
    gpu.warps_per_sm = gpu.warps_per_cta = 1;
    CHECK(replay(gpu, {nodes, {warp({{0}, {0}}), warp({{2}, {2}})}}).all().levels[0].hits == 4);
}

TEST_CASE("warp slots are dealt out among the L1s of an SM") {
    Gpu gpu = one_warp_at_a_time();
    gpu.warps_per_sm = gpu.warps_per_cta = 2;
    CHECK(replay(gpu, {nodes, {warp({{0}}), warp({{0}})}}).all().levels[0].hits == 2);
    gpu.l1_per_sm = 2;
    CHECK(replay(gpu, {nodes, {warp({{0}}), warp({{0}})}}).all().levels[0].hits == 0);
}

TEST_CASE("a later CTA goes to the SM that frees first") {
    // CTA 0 (SM 0) is long, CTA 1 (SM 1) short; CTA 2 reads what CTA 1 read, and hits in the L1 of SM 1.
    Gpu gpu = one_warp_at_a_time();
    gpu.sms = 2;
    CHECK(replay(gpu, {nodes, {warp({{0}, {0}, {0}}), warp({{8}}), warp({{8}})}}).all().levels[0].hits == 4 + 2);
}

TEST_CASE("a launch of nothing counts nothing") {
    CHECK(replay(small_gpu(), {nodes, {}}).groups.empty());
    CHECK(replay(small_gpu(), {nodes, {warp({}), warp({})}}).groups.empty());
}

TEST_CASE("hits and misses add up, and what one level misses the next is asked for") {
    const Launch launch = random_launch(nodes, 60, 40, 11);
    const Counters c = replay(small_gpu(), launch).all();
    CHECK(c.levels[0].sectors == c.levels[0].hits + c.levels[1].sectors);
    CHECK(c.levels[1].sectors == c.levels[1].hits + c.dram_sectors);
    CHECK(c.dram_sectors > 0);
    CHECK(c.dram_first_sectors > 0);
    CHECK(c.dram_first_sectors <= c.dram_sectors);
    CHECK(c.levels[0].hits > 0);
    CHECK(c.levels[1].hits > 0);
}

TEST_CASE("permuting lanes changes nothing while a warp access touches one line") {
    std::mt19937 random(2);
    auto forward = std::make_shared<traces::WarpTrace>(), backward = std::make_shared<traces::WarpTrace>();
    for (int i = 0; i < 300; ++i) {
        const std::uint32_t line = random() % 40, a = 2 * line, b = 2 * line + random() % 2;
        for (const auto& [w, elements] : {std::pair{forward, std::pair{a, b}}, std::pair{backward, std::pair{b, a}}}) {
            w->records.push_back({0b101, 0, traces::RayType::camera, 0, 0});
            w->elements.push_back(elements.first);
            w->elements.push_back(elements.second);
        }
    }
    CHECK(replay(small_gpu(), {nodes, {forward}}) == replay(small_gpu(), {nodes, {backward}}));
}

TEST_CASE("a level that fills 64 bytes reads the neighbour of a missing sector from below") {
    const std::vector<traces::Region> texels{region(ObjectKind::texel, 0x200000, 4, 4, 1000)};
    const Launch launch{texels, {warp({{0}, {8}, {0}, {16}})}};  // sectors 0, 1, 0, 2 of one line
    Gpu gpu = one_warp_at_a_time();
    gpu.levels[1].fill_bytes = 64;
    Counters c = replay(gpu, launch).all();
    CHECK(c.levels[0].hits == 1);
    CHECK(c.levels[1].sectors == 3);
    CHECK(c.levels[1].hits == 1);  // sector 1 came with sector 0
    CHECK(c.dram_sectors == 4);    // 0 and 1, 2 and 3
    gpu.levels[0].fill_bytes = 64;
    c = replay(gpu, launch).all();
    CHECK(c.levels[0].hits == 2);
    CHECK(c.levels[1].sectors == 4);
    CHECK(c.levels[1].hits == 0);
    CHECK(c.dram_sectors == 4);
    gpu.levels[1].fill_bytes = 128;
    c = replay(gpu, launch).all();
    CHECK(c.levels[1].sectors == 4);
    CHECK(c.levels[1].hits == 2);
    CHECK(c.dram_sectors == 4);
}

TEST_CASE("the middle one of three levels belongs to its SM") {
    // Two SMs read the same node, one after the other: each misses in its own L1 and L2, the second hits in L3.
    Gpu gpu = one_warp_at_a_time();
    gpu.sms = 2;
    gpu.levels.push_back(gpu.levels[1]);
    const Counters c = replay(gpu, {nodes, {warp({{0}}), warp({{0}})}}).all();
    CHECK(c.levels[0].sectors == 4);
    CHECK(c.levels[0].hits == 0);
    CHECK(c.levels[1].sectors == 4);
    CHECK(c.levels[1].hits == 0);
    CHECK(c.levels[2].sectors == 4);
    CHECK(c.levels[2].hits == 2);
    CHECK(c.dram_sectors == 2);
}

TEST_CASE("a machine of 8 lanes runs a record as the vectors that have active lanes") {
    Gpu gpu = one_warp_at_a_time();
    gpu.simd_width = 8;
    auto w = std::make_shared<traces::WarpTrace>();
    w->records.push_back({0x80000081u, 0, traces::RayType::camera, 0, 0});  // lanes 0, 7 and 31
    w->elements = {0, 1, 0};
    const Counters c = replay(gpu, {nodes, {w}}).all();
    CHECK(c.warp_accesses == 2);
    CHECK(c.lane_accesses == 3);
    CHECK(c.loads == 2 * 4);
    CHECK(c.levels[0].sectors == 4 + 2);
    CHECK(c.levels[0].hits == 2);
    // A warp's vectors take a turn each: with one line of L1 and another warp in between, nothing is found again.
    gpu.warps_per_sm = gpu.warps_per_cta = 2;
    gpu.levels[0].sets = gpu.levels[0].ways = 1;
    auto other = std::make_shared<traces::WarpTrace>(*w);
    other->elements = {8, 9, 8};
    CHECK(replay(gpu, {nodes, {w, other}}).all().levels[0].hits == 0);
    gpu.simd_width = 32;
    CHECK(replay(gpu, {nodes, {w, other}}).all().warp_accesses == 2);
}

TEST_CASE("the same launch gives the same counts every time") {
    const Launch launch = random_launch(nodes, 60, 40, 12);
    CHECK(replay(small_gpu(), launch) == replay(small_gpu(), launch));
}

TEST_CASE("warps are let go soon after they end") {
    Gpu gpu = one_warp_at_a_time();
    Replay replay(gpu, nodes, 0);
    const auto first = warp({{0}, {1}});
    const std::weak_ptr<const traces::WarpTrace> watched = first;
    replay.push(first);
    CHECK(watched.use_count() == 2);
    // Each needs the only slot. What a window of rounds has issued is looked up behind it, while the next is issued.
    constexpr int rounds_of_some_windows = 1 << 12;
    for (int i = 0; i < rounds_of_some_windows && watched.use_count() > 1; ++i) replay.push(warp({{2}}));
    CHECK(watched.use_count() == 1);
    replay.finish();
}

TEST_CASE("records that contradict the regions are refused") {
    const auto refused = [](const traces::WarpTrace& w, const char* what) {
        Replay replay(small_gpu(), nodes, 0);
        CHECK_THROWS_WITH(replay.push(std::make_shared<traces::WarpTrace>(w)),
                          Catch::Contains("launch 0, warp 0") && Catch::Contains(what));
    };
    traces::WarpTrace good = *warp({{1, 2}}), w = good;
    w.records[0].region = 1;
    refused(w, "region");
    w = good;
    w.records[0].ray = static_cast<traces::RayType>(3);
    refused(w, "ray type");
    w = good;
    w.elements[1] = 1000;
    refused(w, "1000");
    w = good;
    w.elements.pop_back();
    refused(w, "2 active lanes");
    w = good;
    w.elements.push_back(0);
    refused(w, "2 elements");
    w = good;
    w.records[0].mask = 0;
    refused(w, "active lanes");
}

TEST_CASE("a GPU that breaks a rule is refused before anything is allocated") {
    Gpu gpu = small_gpu();
    gpu.levels[1].ways = std::uint64_t{1} << 63;
    CHECK_THROWS_WITH(Replay(gpu, nodes, 0), Catch::Contains("\"small\": l2.ways: expected"));
}

TEST_CASE("counters add beyond 2^32") {
    Counters a;
    a.levels[0].sectors = 0xffffffffu;
    a.dram_sectors = std::uint64_t{1} << 40;
    RayGroup group;
    group.by_kind = {a, a, a};
    group.rays = std::uint64_t{1} << 33;
    LaunchStatistics launch{0, {group, group}};
    CHECK(launch.all().levels[0].sectors == 6 * 0xffffffffull);
    CHECK(launch.all().dram_sectors == 6 * (std::uint64_t{1} << 40));
    CHECK(launch.all().rays == std::uint64_t{1} << 34);
}
