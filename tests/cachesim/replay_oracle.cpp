// Replay against the naive replay: every count must be equal.
#include <catch2/catch.hpp>

#include "oracle.hpp"
#include "random_launch.hpp"

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

TEST_CASE("a replay equals the naive replay for every cache geometry") {
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

TEST_CASE("a replay equals the naive replay for every line and sector size") {
    const auto [line, sector] = GENERATE(table<std::uint32_t, std::uint32_t>(
        {{128, 32}, {128, 128}, {64, 32}, {32, 32}, {16, 4}, {128, 4}, {256, 8}, {4096, 128}}));
    Gpu gpu = small_gpu();
    gpu.levels[0].line_bytes = gpu.levels[1].line_bytes = line;
    gpu.levels[0].sector_bytes = gpu.levels[1].sector_bytes = sector;
    CAPTURE(line, sector);
    check_equal(gpu, usual_regions);
}

TEST_CASE("a replay equals the naive replay for every placement") {
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

TEST_CASE("a replay equals the naive replay where objects straddle many lines or overlap") {
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

TEST_CASE("a replay equals the naive replay near 2^48 and up to the last byte of 2^64") {
    const std::uint64_t top = ~std::uint64_t{0} - 64 * 300 + 1;
    for (const auto index : {SetIndex::modulo, SetIndex::xor_fold}) {
        Gpu gpu = small_gpu();
        gpu.levels[1].sets = 3;
        gpu.levels[0].index = gpu.levels[1].index = index;
        check_equal(gpu, {region(ObjectKind::node, (1ull << 48) - 3200, 64, 64, 300),
                          region(ObjectKind::node, top, 64, 64, 300)});
    }
}

TEST_CASE("a replay equals the naive replay where the lines of a launch need more than 32 bits") {
    check_equal(small_gpu(), {region(ObjectKind::node, 0, 4096, 0xffffffffu, 0xffffffffu),
                              region(ObjectKind::texel, 1ull << 63, 4, 0xfffffff0u, 0x7fffffffu)});
}

TEST_CASE("a replay equals the naive replay on the reference traces", "[slow]") {
    const auto folder = reference_folder();
    if (!folder) {
        WARN("skipped: no reference traces; set RAYCACHE_REFERENCE to their folder");
        return;
    }
    Launch launch = read_reference(*folder, "hr_mj1_1024");
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
