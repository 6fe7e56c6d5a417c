// Replay against the naive replay: every count must be equal.
#include <algorithm>
#include <catch2/catch.hpp>

#include "cachesim/replay/replay.hpp"
#include "oracle.hpp"
#include "random_launch.hpp"
#include "tests/real_data.hpp"

using namespace raycache;
using namespace raycache::cachesim;
using namespace raycache::cachesim::test;
using traces::ObjectKind;

namespace {

const std::vector<traces::Region> usual_regions{region(ObjectKind::node, 0x7f5000000000, 64, 64, 300),
                                                region(ObjectKind::triangle, 0x7f5000200000, 48, 48, 200),
                                                region(ObjectKind::texel, 0x10000000000, 4, 4, 3000)};

void check_equal(const Gpu& gpu, const std::vector<traces::Region>& regions, unsigned warps = 37,
                 unsigned records = 30) {
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        const Launch launch = random_launch(regions, warps, records, seed);
        const LaunchStatistics expected = naive_replay(gpu, launch, 7);
        for (const InstructionSet instructions : instruction_sets())
            REQUIRE(replay(gpu, launch, 7, instructions) == expected);
    }
}

}  // namespace

TEST_CASE("a replay equals the naive replay for every cache geometry", "[oracle]") {
    const auto sets = GENERATE(1, 2, 3, 24, 64);
    const auto ways = GENERATE(1, 2, 3, 4, 5, 8, 17, 48, 63, 64, 65, 512);
    const auto index = GENERATE(SetIndex::modulo, SetIndex::xor_fold);
    Gpu gpu = small_gpu();
    gpu.levels[0].sets = static_cast<std::uint64_t>(sets);
    gpu.levels[0].ways = static_cast<std::uint64_t>(ways);
    gpu.levels[0].index = index;
    gpu.levels[1].ways = 5;
    CAPTURE(sets, ways);
    check_equal(gpu, usual_regions);
    std::swap(gpu.levels[0], gpu.levels[1]);
    check_equal(gpu, usual_regions);
}

TEST_CASE("a replay equals the naive replay for every policy, fill and number of slices", "[oracle]") {
    const auto* const policy = GENERATE("fifo", "lru", "random", "tree_plru");
    const auto slices = GENERATE(1u, 2u, 3u, 36u);
    const auto fill = GENERATE(32u, 64u, 128u);
    Gpu gpu = small_gpu();
    for (CacheGeometry& cache : gpu.levels) {
        cache.policy = policy;
        cache.ways = 3;
    }
    gpu.levels[1].slices = slices;
    gpu.levels[1].slice_hash = SliceHash::xor_fold;
    gpu.levels[1].fill_bytes = fill;
    CAPTURE(policy, slices, fill);
    check_equal(gpu, usual_regions);
    gpu.levels[0].fill_bytes = 64;
    gpu.levels[0].slices = 2;
    check_equal(gpu, usual_regions);
}

TEST_CASE("a replay fills as many empty ways of the last level as the naive replay, for every policy", "[oracle]") {
    const auto* const policy = GENERATE("fifo", "lru", "random", "tree_plru");
    const auto ways = GENERATE(1, 3, 16, 100);
    Gpu gpu = small_gpu();
    gpu.levels.back().policy = policy;
    gpu.levels.back().ways = static_cast<std::uint64_t>(ways);
    CAPTURE(policy, ways);
    const Launch launch = random_launch(usual_regions, 60, 200, 5);  // more than one window
    const LineFills expected = naive_last_level_fills(gpu, launch);
    CHECK(expected.of_empty_ways <= gpu.levels.back().sets * gpu.levels.back().ways);
    for (const InstructionSet instructions : instruction_sets()) {
        Replay replay(gpu, launch.regions, 0, instructions);
        CHECK(replay.last_level_fills() == LineFills{});
        for (const auto& warp : launch.warps) replay.push(warp);
        replay.finish();
        CHECK(replay.last_level_fills() == expected);
    }
}

TEST_CASE("a replay equals the naive replay for three levels", "[oracle]") {
    const auto sms = GENERATE(1u, 2u, 5u);
    const auto l1_per_sm = GENERATE(1u, 2u);
    const auto fill = GENERATE(32u, 64u);
    Gpu gpu = small_gpu();
    gpu.sms = sms;
    gpu.l1_per_sm = l1_per_sm;
    gpu.levels[1].policy = "tree_plru";
    gpu.levels[1].fill_bytes = fill;
    gpu.levels.push_back(gpu.levels[1]);
    gpu.levels[2].slices = 3;
    gpu.levels[2].ways = 13;
    CAPTURE(sms, l1_per_sm, fill);
    check_equal(gpu, usual_regions);
    if (sms == 2 && fill == 64) check_equal(gpu, usual_regions, 60, 200);  // more than one batch of requests
}

TEST_CASE("a replay equals the naive replay for every SIMD width and front end", "[oracle]") {
    const auto width = GENERATE(1u, 2u, 4u, 8u, 16u, 32u);
    const auto load_bytes = GENERATE(4u, 8u, 16u);
    const auto together = GENERATE(1u, 2u, 8u, 32u);
    Gpu gpu = small_gpu();
    gpu.simd_width = width;
    gpu.front_end = {load_bytes, together, std::min(2 * together, 32u), std::min(4 * together, 32u)};
    CAPTURE(width, load_bytes, together);
    check_equal(gpu, usual_regions, 20, 20);
    check_equal(gpu,
                {region(ObjectKind::node, 0x1000010, 100, 36, 90), region(ObjectKind::texel, 0x1000400, 7, 9, 90),
                 region(ObjectKind::node, 0x2000000, 80, 128, 90), region(ObjectKind::node, 0x3000000, 80, 0, 5)},
                10, 10);
}

TEST_CASE("a replay equals the naive replay at every extreme at once", "[oracle]") {
    const auto* const policy = GENERATE("fifo", "lru", "random", "tree_plru");
    Gpu gpu = small_gpu();
    gpu.sms = gpu.warps_per_sm = gpu.warps_per_cta = 1;
    gpu.simd_width = 1;
    for (CacheGeometry& cache : gpu.levels) {
        cache.policy = policy;
        cache.sets = cache.ways = 1;
        cache.line_bytes = cache.sector_bytes = 32;
    }
    CAPTURE(policy);
    check_equal(gpu, usual_regions, 9, 12);
    gpu.levels[0].sets = 7;  // an L2 of one line below it
    gpu.levels[0].ways = 3;
    gpu.sms = 61;  // more SMs than CTAs
    gpu.warps_per_sm = 3;
    check_equal(gpu, usual_regions, 9, 12);
    check_equal(gpu, {region(ObjectKind::node, ~std::uint64_t{0} - 64 * 30 + 1, 64, 64, 30)}, 9, 12);
}

TEST_CASE("a replay equals the naive replay for every line and sector size", "[oracle]") {
    const auto [line, sector] = GENERATE(table<std::uint32_t, std::uint32_t>(
        {{128, 32}, {128, 128}, {64, 32}, {32, 32}, {16, 4}, {128, 4}, {256, 8}, {4096, 128}}));
    Gpu gpu = small_gpu();
    gpu.levels[0].line_bytes = gpu.levels[1].line_bytes = line;
    gpu.levels[0].sector_bytes = gpu.levels[1].sector_bytes = sector;
    CAPTURE(line, sector);
    check_equal(gpu, usual_regions);
}

TEST_CASE("a replay equals the naive replay for every placement", "[oracle]") {
    const auto sms = GENERATE(1u, 2u, 3u, 60u);
    const auto warps_per_sm = GENERATE(1u, 4u, 7u, 40u);
    const auto warps_per_cta = GENERATE(1u, 2u, 8u);
    const auto l1_per_sm = GENERATE(1u, 2u, 3u);
    Gpu gpu = small_gpu();
    gpu.sms = sms;
    gpu.warps_per_sm = warps_per_sm;
    gpu.warps_per_cta = warps_per_cta;
    gpu.l1_per_sm = l1_per_sm;
    CAPTURE(sms, warps_per_sm, warps_per_cta, l1_per_sm);
    check_equal(gpu, usual_regions, 50, 12);
}

TEST_CASE("a replay equals the naive replay where objects straddle many lines or overlap", "[oracle]") {
    Gpu gpu = small_gpu();
    check_equal(
        gpu,
        {region(ObjectKind::node, 0x1000000, 4096, 4096, 9), region(ObjectKind::triangle, 0x2000000, 300, 300, 90)}, 12,
        10);
    check_equal(gpu,
                {region(ObjectKind::node, 0x1000010, 100, 36, 90), region(ObjectKind::texel, 0x1000400, 64, 64, 90)});
    check_equal(gpu, {region(ObjectKind::node, 0x1000000, 80, 0, 5), region(ObjectKind::node, 0, 1, 1, 500)});
    gpu.levels[0].line_bytes = gpu.levels[1].line_bytes = 16;
    gpu.levels[0].sector_bytes = gpu.levels[1].sector_bytes = 8;
    check_equal(gpu, {region(ObjectKind::node, 0x1000000, 4096, 4096, 9)}, 6, 4);
}

TEST_CASE("a replay equals the naive replay near 2^48 and up to the last byte of 2^64", "[oracle]") {
    const std::uint64_t top = ~std::uint64_t{0} - 64 * 300 + 1;
    for (const auto index : {SetIndex::modulo, SetIndex::xor_fold}) {
        Gpu gpu = small_gpu();
        gpu.levels[1].sets = 3;
        gpu.levels[0].index = gpu.levels[1].index = index;
        check_equal(gpu, {region(ObjectKind::node, (1ull << 48) - 3200, 64, 64, 300),
                          region(ObjectKind::node, top, 64, 64, 300)});
    }
}

TEST_CASE("a replay equals the naive replay where the lines of a launch need more than 32 bits", "[oracle]") {
    check_equal(small_gpu(), {region(ObjectKind::node, 0, 4096, 0xffffffffu, 0xffffffffu),
                              region(ObjectKind::texel, 1ull << 63, 4, 0xfffffff0u, 0x7fffffffu)});
}

TEST_CASE("a replay equals the naive replay on the reference traces", "[oracle][slow][data]") {
    const auto path = raycache::test::reference_trace("hr_mj1_1024");
    if (!path) return;
    Launch launch = read_rtwarp(*path);
    launch.warps.resize(80);
    for (const char* name : {"gtx-980-ti", "h100"}) {
        Gpu gpu = load_gpu(name);
        LaunchStatistics expected = naive_replay(gpu, launch);
        for (const InstructionSet instructions : instruction_sets())
            CHECK(replay(gpu, launch, 0, instructions) == expected);
        gpu.sms = 3;
        gpu.levels[1].sets = 57;
        expected = naive_replay(gpu, launch);
        for (const InstructionSet instructions : instruction_sets())
            CHECK(replay(gpu, launch, 0, instructions) == expected);
    }
}
