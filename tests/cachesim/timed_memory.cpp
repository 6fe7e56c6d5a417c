// What stands below the SMs in time: crossbar, slices, DRAM.
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "cachesim/replay/timed/crossbar.hpp"
#include "cachesim/replay/timed/dram.hpp"
#include "timed_cases.hpp"

using namespace raycache;
using namespace raycache::cachesim;
using namespace raycache::cachesim::test;

namespace {

struct Packet {
    Cycle ready = 0;
    std::uint32_t output = 0;
    int name = 0;
};

/// Names of the packets and when they arrive.
std::vector<std::pair<int, double>> arrivals(Crossbar<Packet>& crossbar, Cycle begin, Cycle end) {
    std::vector<std::pair<int, double>> all;
    crossbar.run(begin, end, [&](const Packet& packet, double time) { all.emplace_back(packet.name, time); });
    return all;
}

using Arrivals = std::vector<std::pair<int, double>>;

/// One bank of two-cycle clocks; rows of 4 KiB.
Timing one_bank() {
    Timing t = *timed_gpu().timing;
    t.dram_channels = 1;
    t.dram_bank_bits = {13};
    t.dram_row_bit = 12;
    t.dram_mhz = 500;  // half the SM's clock: each of these takes twice as many cycles
    t.dram_rcd = 10;
    t.dram_rp = 5;
    t.dram_ras = 20;
    t.dram_rc = 30;
    t.dram_rrd = 2;
    return t;
}

/// SM s reads line lines[s], all at cycle 0 but for the round of their CTAs.
TimedStatistics at_once(Gpu gpu, const std::vector<std::uint32_t>& lines) {
    gpu.sms = static_cast<std::uint32_t>(lines.size());
    std::vector<std::vector<std::vector<std::uint32_t>>> warps;
    for (const std::uint32_t line : lines) warps.push_back({{line * elements_per_line}});
    return timed(gpu, launch_of(warps));
}

}  // namespace

TEST_CASE("a packet waits behind others of its input that wait for another output") {
    Crossbar<Packet> crossbar(2, 2, 1, 100);
    crossbar.add(0, {0, 0, 1});
    crossbar.add(1, {0, 0, 2});
    crossbar.add(1, {0, 1, 3});
    CHECK(arrivals(crossbar, 0, 100) == Arrivals{{1, 0}, {2, 1}, {3, 1}});
    CHECK(crossbar.empty());
}

TEST_CASE("an output takes packets at its rate, and goes on with an input whose next packet is for it, too") {
    Crossbar<Packet> crossbar(2, 1, 0.5, 10);
    crossbar.add(0, {0, 0, 1});
    crossbar.add(0, {0, 0, 2});
    crossbar.add(1, {0, 0, 3});
    crossbar.add(1, {20, 0, 4});
    CHECK(arrivals(crossbar, 0, 10) == Arrivals{{1, 0}, {2, 0.5}, {3, 1}});
    CHECK(crossbar.next_time() == 20);
    CHECK(arrivals(crossbar, 10, 20).empty());
    CHECK(arrivals(crossbar, 20, 30) == Arrivals{{4, 20}});
}

TEST_CASE("a packet that is ready before the end of a run in which nothing moved comes in the next run") {
    Crossbar<Packet> crossbar(1, 1, 1, 10);
    CHECK(arrivals(crossbar, 0, 10).empty());
    crossbar.add(0, {5, 0, 1});
    CHECK(arrivals(crossbar, 10, 20) == Arrivals{{1, 5}});
    CHECK(crossbar.empty());
}

TEST_CASE("queues at the outputs never make a launch slower than queues at the inputs") {
    Gpu gpu = timed_gpu();
    gpu.sms = 4;
    gpu.warps_per_sm = gpu.warps_per_cta = 16;
    const Launch launch = random_launch({region(traces::ObjectKind::node, 0x200000, 64, 64, 30000)}, 64, 60, 3);
    const auto outputs = timed(gpu, launch);
    gpu.timing->crossbar_queues = CrossbarQueues::inputs;
    const auto inputs = timed(gpu, launch);
    CHECK(outputs.cycles < inputs.cycles);
    CHECK(inputs.levels[1].requests() > 1000);
}

TEST_CASE("a row that is open is read at once, another after closing and opening") {
    Dram dram(one_bank(), 1, 100);
    CHECK(dram.read(0, 0x0000, 1000) == 1000 + 20 + 100);       // opens: RCD
    CHECK(dram.read(0, 0x0080, 1005) == 1020 + 100);            // goes with it
    CHECK(dram.read(0, 0x0100, 1500) == 1500 + 100);            // open
    CHECK(dram.read(0, 0x1000, 2000) == 2000 + 10 + 20 + 100);  // RP, RCD
    CHECK(dram.read(0, 0x0000, 2001) == 2010 + 60 + 20 + 100);  // RC after the last opening is later than RAS, RP
    CHECK(dram.read(0, 0x2000, 3000) == 3000 + 20 + 100);       // another bank
    CHECK(dram.read(0, 0x6000, 3021) == 3060 + 20 + 100);       // RC after that
}

TEST_CASE("a channel opens rows of its banks no faster than RRD says") {
    Timing t = one_bank();
    t.dram_bank_bits = {13, 14};
    t.dram_rrd = 50;
    Dram dram(t, 1, 0);
    CHECK(dram.read(0, 0x0000, 0) == 20);
    CHECK(dram.read(0, 0x2000, 0) == 100 + 20);
    CHECK(dram.read(0, 0x4000, 0) == 200 + 20);
    CHECK(dram.read(0, 0x0000, 0) == 20 + 0);  // open
}

TEST_CASE("a pointer chase sees the latency of open rows, and of closed ones once") {
    Gpu gpu = timed_gpu();
    gpu.levels[1].slices = 1;
    Timing& t = *gpu.timing;
    t = one_bank();
    std::vector<std::uint32_t> row, rows;
    for (std::uint32_t i = 0; i < 32; ++i) row.push_back(i * elements_per_line);
    CHECK(timed(gpu, launch_of({chase(row)})).cycles == 32 * 500 + 20);
    for (std::uint32_t i = 0; i < 32; ++i) rows.push_back((i % 2 * 32 + i) * elements_per_line);  // two rows in turn
    CHECK(timed(gpu, launch_of({chase(rows)})).cycles == 32 * 500 + 20 + 31 * (10 + 20));
}

TEST_CASE("the latency of DRAM is that of near and far partitions on average") {
    Gpu gpu = timed_gpu();
    gpu.timing->l2_partitions = 2;
    gpu.timing->l2_far_latency = 300;
    std::vector<std::uint32_t> lines;
    for (std::uint32_t i = 0; i < 400; ++i) lines.push_back(i * elements_per_line);
    CHECK(timed(gpu, launch_of({chase(lines)})).cycles == 400 * 500);
}

TEST_CASE("a sector that merges no more holds up its slice, and is then found there") {
    Gpu gpu = timed_gpu();
    gpu.levels[1].slices = 1;
    gpu.timing->l2_mshr_merges = 2;
    // Three SMs ask for line 0, a fourth for line 9. Unloaded: 15 = 500 - 200 + ... each, one a cycle.
    const TimedStatistics holds = at_once(gpu, {0, 0, 0, 9});
    CHECK(holds.levels[1].merges == 1);
    CHECK(holds.levels[1].hits == 1);
    CHECK(holds.levels[1].misses() == 2);
    CHECK(holds.cycles == 300 + 1 + 500);  // looked up a cycle after the data of line 0 are in L2, at 300
    gpu.timing->l2_mshr_merges = 3;
    const TimedStatistics merges = at_once(gpu, {0, 0, 0, 9});
    CHECK(merges.levels[1].merges == 2);
    CHECK(merges.levels[1].hits == 0);
    CHECK(merges.cycles == 3 + 500);
}

TEST_CASE("channels are used alike where their number does not divide that of slices") {
    for (const auto& [slices, channels] : {std::pair{6u, 4u}, {5u, 7u}, {3u, 24u}, {36u, 24u}, {8u, 8u}}) {
        Gpu gpu = timed_gpu();
        gpu.sms = 8;
        gpu.warps_per_sm = gpu.warps_per_cta = 32;
        gpu.levels[1].slices = slices;
        gpu.levels[1].sets = 96;
        gpu.timing->l2_mshrs = 1000;
        gpu.timing->dram_channels = channels;
        gpu.timing->dram_gb_s = 8;  // a sector in four cycles, half of what the warps ask for
        gpu.timing->l2_bytes_per_cycle = 256;
        const auto stream = [&](std::uint32_t lines_per_warp) {
            std::vector<std::vector<std::vector<std::uint32_t>>> warps(256);
            for (std::uint32_t w = 0; w < 256; ++w)
                for (std::uint32_t i = 0; i < lines_per_warp; ++i)
                    warps[w].push_back({(i * 256 + w) * elements_per_line});
            return timed(gpu, launch_of(warps)).cycles;
        };
        CAPTURE(slices, channels);
        CHECK(static_cast<double>(stream(40) - stream(20)) == Approx(4 * 20 * 256).epsilon(0.05));
    }
}
