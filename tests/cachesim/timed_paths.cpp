// The same timed replay by several ways through the code, and beside the functional replay.
#include <catch2/catch.hpp>

#include "cachesim/cache/registry.hpp"
#include "oracle.hpp"
#include "timed_cases.hpp"

using namespace raycache;
using namespace raycache::cachesim;
using namespace raycache::cachesim::test;
using traces::ObjectKind;

namespace {

Gpu busy_gpu() {
    Gpu gpu = timed_gpu();
    gpu.sms = 3;
    gpu.warps_per_sm = 12;
    gpu.warps_per_cta = 4;
    gpu.levels[0].ways = 8;
    gpu.levels[1].sets = 8;
    gpu.timing->schedulers = 4;
    gpu.timing->node_instructions = 10;
    gpu.timing->l1_mshrs = 40;
    gpu.timing->l1_mshr_merges = 3;
    return gpu;
}

/// Nodes that each lie in one line, triangles that straddle lines.
Launch mixed_launch(std::uint64_t seed) {
    return random_launch(
        {region(ObjectKind::node, 0x200000, 64, 64, 200), region(ObjectKind::triangle, 0x800000, 48, 48, 150)}, 60, 60,
        seed);
}

void check_same(const TimedStatistics& a, const TimedStatistics& b) {
    CHECK(a.cycles == b.cycles);
    CHECK(a.levels[0] == b.levels[0]);
    CHECK(a.levels[1] == b.levels[1]);
    CHECK(a.dram_sectors == b.dram_sectors);
    CHECK(a.visit_cycles == b.visit_cycles);
    CHECK(a.l1_port.busy == b.l1_port.busy);
    CHECK(a.l1_tags.busy == Approx(b.l1_tags.busy));
    CHECK(a.l1_mshrs.busy == b.l1_mshrs.busy);
}

}  // namespace

TEST_CASE("lines numbered with gaps between regions are timed like lines numbered as they come") {
    // So many lines that ids are given in order of touch: then every load takes the way for any address.
    const traces::Region huge = region(ObjectKind::texel, 1ull << 40, 16, 4096, 1u << 31);
    for (const L1Port port : {L1Port::tags, L1Port::banks}) {
        for (const std::uint64_t seed : {1, 2, 3}) {
            Gpu gpu = busy_gpu();
            gpu.timing->l1_port = port;
            Launch launch = mixed_launch(seed);
            const TimedStatistics dense = timed(gpu, launch);
            launch.regions.push_back(huge);
            CAPTURE(seed);
            check_same(timed(gpu, launch), dense);
            CHECK(dense.levels[0].merges > 0);
            CHECK(dense.levels[0].hits > 1000);
        }
    }
}

TEST_CASE("a port that carries hardly more than whole sectors is timed like one that carries whole sectors") {
    for (const std::uint64_t seed : {4, 5}) {
        Gpu gpu = busy_gpu();
        gpu.timing->l1_bytes_per_cycle = 64;
        const TimedStatistics whole = timed(gpu, mixed_launch(seed));
        gpu.timing->l1_bytes_per_cycle *= 1 + 1e-12;
        check_same(timed(gpu, mixed_launch(seed)), whole);
    }
}

TEST_CASE("a port that carries one and a half sectors a cycle takes two cycles for three") {
    Gpu gpu = timed_gpu();
    gpu.warps_per_sm = gpu.warps_per_cta = 32;
    gpu.timing->l1_bytes_per_cycle = 48;
    gpu.timing->load_queue = 64;
    const auto cycles = [&](std::size_t accesses) {
        return timed(gpu, launch_of(std::vector(32, std::vector(accesses, std::vector<std::uint32_t>{0, 2, 4}))))
            .cycles;
    };
    // 32 warps x 2 cycles are more than the 30 of a hit: the port is the limit.
    CHECK(static_cast<double>(cycles(300) - cycles(100)) == Approx(200 * 32 * 2).epsilon(0.02));
}

TEST_CASE("one warp alone hits what it hits without time, under every policy, over two levels and three") {
    for (const std::string& policy : cache_policies()) {
        for (const bool three : {false, true}) {
            Gpu gpu = timed_gpu();
            gpu.levels[0].sets = 3;
            gpu.levels[0].ways = 32;
            gpu.levels[1].sets = 5;
            gpu.levels[1].ways = 12;
            gpu.levels[1].slices = 1;
            if (three) {
                gpu.levels.push_back(gpu.levels[1]);
                gpu.levels[2].sets = 7;
                gpu.levels[2].ways = 33;
                gpu.levels[2].slices = 2;
                gpu.timing->l3_latency = 300;
                gpu.timing->l3_mshrs = 64;
                gpu.timing->l3_mshr_merges = 4;
            }
            for (CacheGeometry& level : gpu.levels) level.policy = policy;
            gpu.levels[0].policy = "lru";  // where a line is looked up by each load of a visit, order matters
            gpu.levels[0].sets = 1;
            gpu.levels[0].ways = 2;
            const Launch launch = random_launch({region(ObjectKind::node, 0x200000, 16, 128, 900)}, 1, 4000, 11);
            Launch single{launch.regions, {}};  // a line at a time, so that none is held by a sector on its way
            for (const auto& warp : launch.warps) {
                auto chase = std::make_shared<traces::WarpTrace>(*warp);
                chase->records.clear();
                traces::Record record;
                record.mask = 1;
                chase->records.assign(chase->elements.size(), record);
                single.warps.push_back(chase);
            }
            const Counters counts = replay(gpu, single).all();
            const TimedStatistics t = timed(gpu, single);
            CAPTURE(policy, three);
            CHECK(counts.levels[0].sectors > 1000);
            CHECK(t.levels[0].requests() == counts.levels[0].sectors);
            CHECK(t.levels[0].misses() == counts.levels[1].sectors);
            CHECK(t.levels[0].merges == 0);
            if (three) CHECK(t.levels[1].misses() == counts.levels[2].sectors);
            CHECK(t.levels[three ? 2 : 1].misses() == counts.dram_sectors);
            CHECK(t.dram_sectors == counts.dram_sectors);
            CHECK(counts.dram_sectors < counts.levels[1].sectors);
        }
    }
}

TEST_CASE("sectors smaller than half a load, and vectors of few lanes, are asked for one by one") {
    for (const std::uint32_t sector : {4u, 8u, 16u}) {
        for (const std::uint32_t width : {4u, 32u}) {
            Gpu gpu = busy_gpu();
            gpu.simd_width = width;
            for (CacheGeometry& level : gpu.levels) {
                level.sector_bytes = sector;
                level.fill_bytes = sector;
            }
            const Launch launch = mixed_launch(sector + width);
            const TimedStatistics t = timed(gpu, launch);
            CAPTURE(sector, width);
            CHECK(t.levels[0].requests() == replay(gpu, launch).all().levels[0].sectors);
            CHECK(t.lane_accesses == launch.lane_accesses());
            CHECK(t.levels[1].requests() == t.levels[0].misses());
        }
    }
}

TEST_CASE("what a fill of L1 brings beside a missing sector hits later") {
    Gpu gpu = timed_gpu();
    const Launch launch = launch_of({chase({0, 2, 4, 6})});  // the four sectors of one line
    const TimedStatistics apart = timed(gpu, launch);
    CHECK(apart.cycles == 4 * 500);
    CHECK(apart.levels[0].sector_misses == 3);
    gpu.levels[0].fill_bytes = 128;
    const TimedStatistics together = timed(gpu, launch);
    CHECK(together.levels[0].hits == 3);
    CHECK(together.levels[0].misses() == 1);
    CHECK(together.levels[1].requests() == 4);
    CHECK(together.dram_sectors == 4);
    CHECK(together.cycles <= 500 + 3 * 30 + 4);
}

TEST_CASE("a launch that waits long for few bytes ends as soon as its cycles are known") {
    Gpu gpu = timed_gpu();
    gpu.timing->dram_gb_s = 0.001;  // 32 000 cycles a sector of one channel, four of them
    std::vector<std::uint32_t> lines;
    for (std::uint32_t i = 0; i < 4000; ++i) lines.push_back(i * elements_per_line);
    const TimedStatistics t = timed(gpu, launch_of({chase(lines)}));
    CHECK(t.dram_sectors == 4000);
    CHECK(t.cycles > 4000 * 500);
    gpu.timing->dram_gb_s = 1.3e-4;  // the slowest that is allowed
    gpu.warps_per_sm = gpu.warps_per_cta = 32;
    std::vector<std::vector<std::vector<std::uint32_t>>> warps;
    for (std::uint32_t w = 0; w < 32; ++w) warps.push_back({{w * elements_per_line}});
    CHECK(timed(gpu, launch_of(warps)).cycles == Approx(32 / 4 * 32 / 1.3e-4 * 4).epsilon(0.2));
}
