// The requests exported of DRAM are those that the timed replay counts, in order of time.
#include "cachesim/export/dram_stream.hpp"

#include <catch2/catch.hpp>
#include <map>
#include <sstream>

#include "tests/cachesim/timed_cases.hpp"

using namespace raycache;
using namespace raycache::cachesim;
using namespace raycache::cachesim::test;
using traces::ObjectKind;

namespace {

struct Line {
    std::string address, what;
    Cycle cycle = 0;
};

struct ExportedDram {
    std::string text;
    std::vector<Line> lines;
    TimedStatistics counts;
    std::uint64_t reads = 0, writes = 0, sorted = 0;
};

const DramFormat& dram_format(const std::string& name) {
    for (const DramFormat& f : dram_formats())
        if (f.name == name) return f;
    throw std::runtime_error("no format " + name);
}

/// `kernels`: how many warps one has; 0: all.
ExportedDram export_dram(const Gpu& gpu, const Launch& launch, const std::string& name, double ratio = 1,
                         std::size_t kernel_warps = 0) {
    ExportedDram made;
    DramStream stream(dram_format(name), ratio, [&](std::string_view piece) { made.text += piece; });
    TimedReplay replay(gpu, launch.regions, 0);
    replay.observe(stream);
    for (std::size_t w = 0; w < launch.warps.size(); ++w) {
        if (kernel_warps && w && w % kernel_warps == 0) replay.end_kernel();
        replay.push(launch.warps[w]);
    }
    made.counts = replay.finish();
    stream.flush();
    made.reads = stream.reads();
    made.writes = stream.writes();
    made.sorted = stream.sorted();
    std::istringstream text(made.text);
    for (std::string line; std::getline(text, line);) {
        std::istringstream words(line);
        Line& l = made.lines.emplace_back();
        words >> l.address >> l.what;
        if (name == "dramsim3") words >> l.cycle;
    }
    return made;
}

}  // namespace

TEST_CASE("every sector that a timed replay reads from DRAM is one request, and cycles ascend") {
    for (const Gpu& gpu : {small_timed_gpu(), cramped_gpu(2)}) {
        for (const std::uint32_t fill : {32u, 128u}) {
            Gpu changed = gpu;
            changed.levels[1].fill_bytes = fill;
            const Launch launch = random_launch(objects, 40, 60, fill);
            const ExportedDram made = export_dram(changed, launch, "dramsim3");
            const TimedStatistics silent = timed(changed, launch);
            CHECK(made.counts.cycles == silent.cycles);  // to listen changes nothing
            CHECK(made.counts.levels == silent.levels);
            REQUIRE(made.lines.size() == made.counts.dram_sectors);
            CHECK(made.lines.size() > 100);
            std::map<std::uint64_t, int> asked;
            Cycle before = 0;
            for (const Line& line : made.lines) {
                CHECK(line.what == "READ");
                REQUIRE(line.cycle >= before);
                before = line.cycle;
                const std::uint64_t address = std::stoull(line.address, nullptr, 16);
                CHECK(address % 32 == 0);
                CHECK(((address >= 0x200000 && address < 0x200000 + 64 * 3000) ||
                       (address >= 0x800000 && address < 0x800000 + 48 * 2000 + 128)));
                ++asked[address];
            }
            CHECK(asked.size() > 50);
            if (fill == 32) CHECK(before < made.counts.cycles);  // what is fetched beside may come after the last warp
        }
    }
}

TEST_CASE("a lone read comes to DRAM when both levels have missed") {
    auto warp = std::make_shared<traces::WarpTrace>();
    warp->records = {{1u, 0, traces::RayType::camera, 0, 0}, {1u, 0, traces::RayType::camera, 0, 0}};
    warp->elements = {0, 1000};
    const ExportedDram made = export_dram(timed_gpu(), {pieces, {warp}}, "dramsim3");
    REQUIRE(made.lines.size() == 2);
    CHECK(made.lines[0].address == "0x200000");
    CHECK(made.lines[1].address == "0x203e80");
    CHECK(made.lines[0].cycle < 30);                          // the second waits for the first:
    CHECK(made.lines[1].cycle - made.lines[0].cycle >= 500);  // the latency of DRAM is that of the whole way
    CHECK(made.lines[1].cycle - made.lines[0].cycle < 520);
    const ExportedDram half = export_dram(timed_gpu(), {pieces, {warp}}, "dramsim3", 0.5);
    for (int i : {0, 1}) CHECK(half.lines[i].cycle == made.lines[i].cycle / 2);
}

TEST_CASE("the formats of DRAM simulators say the same requests in the same order") {
    const Launch launch = random_launch(objects, 20, 40, 3);
    const ExportedDram timed_file = export_dram(small_timed_gpu(), launch, "dramsim3"),
                       first = export_dram(small_timed_gpu(), launch, "ramulator"),
                       second = export_dram(small_timed_gpu(), launch, "ramulator2");
    REQUIRE(first.lines.size() == timed_file.lines.size());
    REQUIRE(second.lines.size() == timed_file.lines.size());
    for (std::size_t i = 0; i < first.lines.size(); ++i) {
        CHECK(first.lines[i].address == timed_file.lines[i].address);
        CHECK(first.lines[i].what == "R");
        CHECK(second.lines[i].address == "LD");
        CHECK(second.lines[i].what == timed_file.lines[i].address);
    }
}

TEST_CASE("what a wavefront writes are writes of DRAM, and what it sorts is only counted") {
    std::vector<traces::Region> regions = objects;
    regions.push_back(region(ObjectKind::hit_write, 0x1000000, 32, 32, 3000));
    const Launch stored = random_launch(regions, 24, 40, 5);
    const ExportedDram made = export_dram(small_timed_gpu(), stored, "dramsim3", 1, 8);
    std::uint64_t writes = 0;
    Cycle before = 0;
    for (const Line& line : made.lines) {
        const bool is_write = std::stoull(line.address, nullptr, 16) >= 0x1000000;
        CHECK(line.what == (is_write ? "WRITE" : "READ"));
        writes += is_write;
        REQUIRE(line.cycle >= before);
        before = line.cycle;
    }
    CHECK(made.lines.size() == made.counts.dram_sectors);
    CHECK(made.writes == writes);
    CHECK(made.reads + writes == made.lines.size());
    CHECK(writes > 100);
    CHECK(made.sorted == 0);

    regions.back() = region(ObjectKind::sort, 0x1000000, 32, 32, 3000);
    const ExportedDram sorts = export_dram(small_timed_gpu(), random_launch(regions, 24, 40, 5), "ramulator", 1, 8);
    CHECK(sorts.sorted > 0);
    CHECK(sorts.writes == 0);
    CHECK(sorts.lines.size() + sorts.sorted == sorts.counts.dram_sectors);
}
