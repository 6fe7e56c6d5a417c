// What a wavefront adds to a replay: kernels, writes, sorts.
#include <algorithm>
#include <bit>
#include <catch2/catch.hpp>
#include <list>
#include <random>

#include "cachesim/replay/replay.hpp"
#include "cachesim/replay/timed/timed_replay.hpp"
#include "cachesim/replay/write_back.hpp"
#include "oracle.hpp"
#include "random_launch.hpp"
#include "traces/error.hpp"

using namespace raycache;
using namespace raycache::cachesim;
using namespace raycache::cachesim::test;
using traces::ObjectKind;

namespace {

constexpr std::uint8_t get = 0, put = 1, sort_region = 2;
const std::vector<traces::Region> buffers{region(ObjectKind::ray_state, 0x200000, 32, 32, 1000),
                                          region(ObjectKind::ray_state_write, 0x200000, 32, 32, 1000),
                                          region(ObjectKind::sort, 0x800000, 108, 108, 1000)};

struct Access {
    std::uint8_t region;
    std::vector<std::uint32_t> elements;
};

std::shared_ptr<const traces::WarpTrace> warp(const std::vector<Access>& accesses) {
    auto w = std::make_shared<traces::WarpTrace>();
    for (const Access& a : accesses) {
        traces::Record record;
        record.mask = static_cast<std::uint32_t>((std::uint64_t{1} << a.elements.size()) - 1);
        record.region = a.region;
        w->records.push_back(record);
        w->elements.insert(w->elements.end(), a.elements.begin(), a.elements.end());
    }
    return w;
}

/// One SM; an L1 of one line, an L2 of two.
Gpu tiny_gpu() {
    Gpu gpu = small_gpu();
    gpu.sms = gpu.warps_per_sm = gpu.warps_per_cta = 1;
    gpu.levels[0].sets = gpu.levels[0].ways = gpu.levels[1].sets = 1;
    gpu.levels[1].ways = 2;
    return gpu;
}

/// Counts by kind of one warp per kernel.
std::array<Counters, traces::object_kinds> counts(const Gpu& gpu, const std::vector<std::vector<Access>>& kernels) {
    Replay replay(gpu, buffers, 0);
    for (std::size_t k = 0; k < kernels.size(); ++k) {
        if (k > 0) replay.end_kernel();
        replay.push(warp(kernels[k]));
    }
    const LaunchStatistics s = replay.finish();
    REQUIRE(s.groups.size() == 1);
    return s.groups[0].by_kind;
}

Counters of(const std::array<Counters, traces::object_kinds>& counters, ObjectKind kind) {
    return counters[static_cast<unsigned>(kind)];
}

}  // namespace

TEST_CASE("writes and sorts count as computed by hand") {
    // Line 0 is written in L2, not in L1; read from there; written again before it was evicted.
    const auto c = counts(tiny_gpu(), {{{put, {0}}, {get, {0}}, {put, {0}}, {sort_region, {5, 6}}}});
    Counters reads;
    reads.lane_accesses = reads.warp_accesses = reads.levels[0].sectors = reads.levels[1].sectors =
        reads.levels[1].hits = 1;
    reads.loads = reads.requests = 2;  // of 16 B
    CHECK(of(c, ObjectKind::ray_state) == reads);
    Counters writes;
    writes.lane_accesses = writes.warp_accesses = writes.levels[0].sectors = writes.levels[1].sectors = 2;
    writes.loads = writes.requests = 4;
    writes.levels[1].hits = writes.dram_sectors = writes.written_sectors = 1;
    CHECK(of(c, ObjectKind::ray_state_write) == writes);
    Counters sorts;
    sorts.lane_accesses = 2;
    sorts.warp_accesses = 1;
    sorts.requests = sorts.levels[0].sectors = sorts.levels[1].sectors = sorts.dram_sectors = sorts.sort_sectors =
        7;  // 216 B
    CHECK(of(c, ObjectKind::sort) == sorts);
}

TEST_CASE("a sector that is changed, evicted and changed again is written to DRAM twice") {
    const auto c = counts(tiny_gpu(), {{{put, {0}}, {get, {4}}, {get, {8}}, {put, {0}}}});
    CHECK(of(c, ObjectKind::ray_state_write).dram_sectors == 2);
    CHECK(of(c, ObjectKind::ray_state).dram_sectors == 2);
}

TEST_CASE("a sector that is changed, evicted and read comes from DRAM") {
    const auto c = counts(tiny_gpu(), {{{put, {0}}, {get, {4}}, {get, {8}}, {get, {0}}, {put, {0}}}});
    CHECK(of(c, ObjectKind::ray_state).dram_sectors == 3);
    CHECK(of(c, ObjectKind::ray_state_write).dram_sectors == 2);
}

TEST_CASE("a kernel finds nothing in L1 and everything in L2; the caches of a CPU keep what they have") {
    const auto same = counts(tiny_gpu(), {{{get, {0}}, {get, {0}}}});
    CHECK(of(same, ObjectKind::ray_state).levels[0].hits == 1);
    const auto next = counts(tiny_gpu(), {{{get, {0}}}, {{get, {0}}}});
    CHECK(of(next, ObjectKind::ray_state).levels[0].hits == 0);
    CHECK(of(next, ObjectKind::ray_state).levels[1].hits == 1);
    Gpu cpu = tiny_gpu();
    cpu.levels.push_back(cpu.levels[1]);
    CHECK(of(counts(cpu, {{{get, {0}}}, {{get, {0}}}}), ObjectKind::ray_state).levels[0].hits == 1);
}

TEST_CASE("kernels of many warps count what they count alone, but for what L2 keeps") {
    Gpu gpu = small_gpu();
    gpu.levels[1].sets = 4096;  // room for all
    const std::vector<traces::Region> nodes{region(ObjectKind::node, 0x200000, 64, 64, 5000)};
    const Launch launch = random_launch(nodes, 37, 40, 4);
    const Counters alone = replay(gpu, launch, 0).all();
    Replay twice(gpu, nodes, 0);
    for (int kernel = 0; kernel < 2; ++kernel) {
        if (kernel > 0) twice.end_kernel();
        for (const auto& w : launch.warps) twice.push(w);
    }
    const Counters both = twice.finish().all();
    CHECK(both.rays == 2 * alone.rays);
    CHECK(both.levels[0].sectors == 2 * alone.levels[0].sectors);
    CHECK(both.levels[0].hits == 2 * alone.levels[0].hits);
    CHECK(both.levels[1].sectors == 2 * alone.levels[1].sectors);
    CHECK(both.dram_sectors == alone.dram_sectors);
}

TEST_CASE("writes to DRAM are those of a cache with dirty bits") {
    std::mt19937 random(7);
    WriteBack write_back;
    struct Line {
        std::uint32_t line, present, dirty;
    };
    std::list<Line> cache;  // newest first, 8 lines
    std::uint64_t expected = 0, found = 0;
    for (int i = 0; i < 50000; ++i) {
        const std::uint32_t line = random() % 20;
        const std::uint32_t sectors = 1 + random() % 15;
        auto at = std::find_if(cache.begin(), cache.end(), [&](const Line& l) { return l.line == line; });
        if (at == cache.end()) {
            cache.push_front({line, 0, 0});
            if (cache.size() > 8) {
                expected += static_cast<unsigned>(std::popcount(cache.back().dirty));
                cache.pop_back();
            }
        } else {
            cache.splice(cache.begin(), cache, at);
        }
        Line& now = cache.front();
        const std::uint32_t fetched = sectors & ~now.present;
        now.present |= sectors;
        if (random() % 2 == 0) {
            now.dirty |= sectors;
            found += static_cast<unsigned>(std::popcount(write_back.write(line, sectors, fetched)));
        } else {
            write_back.read(line, fetched);
        }
    }
    for (const Line& line : cache) expected += static_cast<unsigned>(std::popcount(line.dirty));
    CHECK(found == expected);
    CHECK(found > 10000);
}

TEST_CASE("in time, a kernel waits for the one before, and streamed bytes take the time of DRAM's bandwidth") {
    Gpu gpu = tiny_gpu();
    Timing t;
    t.clock_mhz = 1000;
    t.schedulers = 1;
    t.l1_latency = 30;
    t.l2_latency = t.l2_far_latency = 200;
    t.dram_latency = 500;
    t.launch_cycles = 1000;
    t.l1_mshrs = t.l2_mshrs = 64;
    t.l1_mshr_merges = t.l2_mshr_merges = 8;
    t.dram_channels = 1;
    t.dram_gb_s = 64;  // 2 sectors a cycle
    gpu.timing = t;
    const auto run = [&](const std::vector<std::vector<Access>>& kernels) {
        TimedReplay replay(gpu, buffers, 0);
        for (std::size_t k = 0; k < kernels.size(); ++k) {
            if (k > 0) replay.end_kernel();
            replay.push(warp(kernels[k]));
        }
        return replay.finish();
    };
    const TimedStatistics one = run({{{get, {0}}}}), two = run({{{get, {0}}}, {{get, {0}}}});
    CHECK(one.dram_sectors == 1);
    CHECK(two.dram_sectors == 1);  // L2 keeps it
    CHECK(two.levels[0].requests() == 2 * one.levels[0].requests());
    const std::uint64_t second = two.cycles - one.cycles;
    CHECK(second >= 1000 + 200);
    CHECK(second <= 1000 + 200 + 300);  // a window of cycles may pass

    std::vector<std::uint32_t> lanes(32);
    const TimedStatistics sorted = run({{{get, {0}}, {sort_region, lanes}}});  // 3456 B
    CHECK(sorted.cycles == one.cycles + 54);
    CHECK(sorted.dram_sectors == one.dram_sectors + 108);
    const TimedStatistics wrote = run({{{put, {0, 1, 2, 3, 3}}, {get, {0}}}});
    CHECK(wrote.cycles == one.cycles + 2);
    CHECK(wrote.dram_sectors == one.dram_sectors + 4);
    CHECK(wrote.warp_accesses == one.warp_accesses);
}

TEST_CASE(
    "in time as without, the caches of a CPU keep what they have from kernel to kernel, those of a GPU L2 alone") {
    Gpu gpu = tiny_gpu();
    gpu.levels[0].ways = 4;
    gpu.levels[1].ways = 16;
    Timing t;
    t.clock_mhz = 1000;
    t.schedulers = 1;
    t.l1_latency = 5;
    t.l2_latency = t.l2_far_latency = 15;
    t.l3_latency = 60;
    t.dram_latency = 200;
    t.launch_cycles = 100;
    t.l1_mshrs = t.l2_mshrs = t.l3_mshrs = 16;
    t.l1_mshr_merges = t.l2_mshr_merges = t.l3_mshr_merges = 8;
    t.dram_gb_s = 64;
    gpu.timing = t;
    for (const bool cpu : {false, true}) {
        if (cpu) gpu.levels.push_back(gpu.levels[1]);
        for (const std::uint32_t fill : {32u, 128u}) {
            gpu.levels[0].fill_bytes = fill;  // a CPU's L1 may still fetch when the last warp has ended
            TimedReplay timed(gpu, buffers, 0);
            Replay counted(gpu, buffers, 0);
            for (int kernel = 0; kernel < 3; ++kernel) {
                if (kernel > 0) {
                    timed.end_kernel();
                    counted.end_kernel();
                }
                std::vector<Access> accesses;
                for (std::uint32_t line = 0; line < 8; ++line)
                    accesses.push_back({get, {4 * (line < 3 ? line : 3 + (line + static_cast<unsigned>(kernel)) % 8)}});
                timed.push(warp(accesses));
                counted.push(warp(accesses));
            }
            const TimedStatistics times = timed.finish();
            const Counters counts = counted.finish().all();
            CAPTURE(cpu, fill);
            CHECK(times.dram_sectors == counts.dram_sectors);
            if (fill > 32) continue;
            CHECK(times.levels[1].requests() == counts.levels[1].sectors);
            if (cpu) CHECK(times.levels[2].requests() == counts.levels[2].sectors);
            CHECK(times.levels[0].misses() == counts.levels[1].sectors);
        }
    }
}

TEST_CASE("requests of a wavefront cannot be followed") {
    struct Sink final : RequestSink {
        bool wants(std::size_t, unsigned) const override { return true; }
        void served(std::size_t, std::span<const ServedRequest>) override {}
    } sink;
    Replay replay(tiny_gpu(), buffers, 0);
    CHECK_THROWS_WITH(replay.observe(sink), Catch::Matchers::Contains("trace of a wavefront"));
}
