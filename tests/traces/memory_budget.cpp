// One budget for all that an input makes the program allocate.
#include "traces/memory_budget.hpp"

#include <catch2/catch.hpp>

#include "tests/traces/files.hpp"
#include "traces/accelsim/import.hpp"
#include "traces/compression.hpp"
#include "traces/link_table.hpp"
#include "traces/reader.hpp"
#include "traces/rtwarp/import.hpp"
#include "traces/verify.hpp"
#include "traces/writer.hpp"

using namespace raycache;
using namespace raycache::traces;

namespace {

/// For the life of the object; then the default again.
struct LimitedMemory {
    explicit LimitedMemory(std::uint64_t bytes) { set_memory_limit(bytes); }
    ~LimitedMemory() { set_memory_limit(before_); }
    std::uint64_t before_ = memory_limit();
};

/// A trace of one empty warp whose regions hold `links` links each, all alike: a few bytes a million.
void write_linked(const std::string& path, std::size_t regions, std::uint32_t links) {
    Header header;
    for (std::size_t r = 0; r < regions; ++r) {
        Region region;
        region.element_size = region.stride = 16;
        region.base = (r + 1) << 40;
        region.count = links;
        region.degree = 1;
        region.links.assign(links, no_link);
        header.regions.push_back(std::move(region));
    }
    header.launches = {0};
    header.warps_per_launch = 1;
    Writer writer(path, header);
    writer.append(encode_block(header, std::vector<WarpTrace>(1)));
    writer.finish();
}

bool mentions(const std::string& message, const char* part) {
    INFO(message);
    return message.find(part) != std::string::npos && message.find("--memory-limit") != std::string::npos &&
           message.find('\n') == std::string::npos;
}

}  // namespace

TEST_CASE("a budget adds up, refuses what is too much and takes back") {
    MemoryBudget budget(100);
    budget.charge(60, "a", "b");
    CHECK(mentions(refusal([&] { budget.charge(41, "file", "thing"); }),
                   "file: thing: expected one input to need at most 100 bytes of memory, found 101 bytes"));
    CHECK(budget.used() == 60);
    CHECK_THROWS_AS(budget.check(41, "", ""), MemoryError);
    {
        const MemoryHold hold(budget, 40, "", "");
        CHECK(budget.left() == 0);
    }
    CHECK(budget.left() == 40);
    budget.release(60);
    CHECK_NOTHROW(budget.charge(100, "", ""));
    CHECK_THROWS_AS(budget.charge(~std::uint64_t{0}, "", ""), MemoryError);
}

TEST_CASE("a frame that does not hold what a file says takes no memory before it is refused") {
    const Bytes few(10, 7);
    Bytes stored, raw;
    compress(few, Effort::small, stored);
    constexpr std::uint64_t claimed = std::uint64_t{1} << 50;  // more than any machine has
    CHECK_THROWS_WITH(decompress(stored, claimed, {}, raw), Catch::Contains("found 10 bytes"));
    CHECK(raw.capacity() == 0);
    std::vector<Region> regions(1);
    regions[0].degree = 16;
    regions[0].count = (1U << 30) - 1;
    CHECK_THROWS_WITH(decode_links(regions, 0, LinkPrediction::element, stored, {}), Catch::Contains("found 10 bytes"));
    CHECK(regions[0].links.capacity() == 0);
    decompress(stored, few.size(), {}, raw);
    CHECK(raw == few);
}

TEST_CASE("sizes are told in binary units") {
    CHECK(size_text(0) == "0 bytes");
    CHECK(size_text(1023) == "1023 bytes");
    CHECK(size_text(4ULL << 30) == "4 GiB");
    CHECK(size_text(1536) == "1.5 KiB");
    CHECK(machine_memory() > 1U << 20);
    CHECK(memory_limit() == machine_memory() / 4);
}

TEST_CASE("the link tables of all regions together are bounded, before they are decompressed") {
    const TemporaryFolder folder;
    write_linked(folder / "a.rct", 8, 1 << 18);  // 8 MiB
    CHECK(std::filesystem::file_size(folder / "a.rct") < 8192);
    CHECK(Reader(folder / "a.rct").header().regions[7].links.back() == no_link);
    const LimitedMemory limit(6 << 20);
    CHECK(mentions(refusal([&] { Reader(folder / "a.rct"); }), "links of its regions"));
    CHECK(mentions(refusal([&] { recover(folder / "a.rct", folder / "b.rct"); }), "links of its regions"));
    CHECK_FALSE(std::filesystem::exists(folder / "b.rct"));
}

TEST_CASE("the records of a block are bounded, before it is decompressed") {
    const TemporaryFolder folder;
    Header header;
    Region region;
    region.element_size = region.stride = 16;
    region.base = std::uint64_t{1} << 40;
    region.count = 1;
    header.regions = {region};
    header.launches = {0};
    header.warps_per_launch = 1;
    std::vector<WarpTrace> warps(1);
    for (int i = 0; i < 1 << 18; ++i) warps[0].records.push_back({1, ray_start, RayType::camera, 0, 0});
    {
        Writer writer(folder / "a.rct", header);
        writer.append(encode_block(header, warps));
        writer.finish();
    }
    CHECK(verify(folder / "a.rct").records == 1 << 18);
    const LimitedMemory limit(1 << 20);
    CHECK(mentions(refusal([&] { verify(folder / "a.rct"); }), "records of a block"));
    CHECK(mentions(refusal([&] { recover(folder / "a.rct", folder / "b.rct"); }), "records of a block"));
}

TEST_CASE("an import stays within the budget, whatever its text or bytes ask for") {
    const TemporaryFolder folder;
    const auto write = [&](const std::string& name, std::string_view text) {
        write_file(folder / name, {text.begin(), text.end()});
        return folder / name;
    };
    std::string text =
        "-kernel name = k\n-grid dim = (1,1,1)\n-block dim = (32,1,1)\n-enable lineinfo = 0\n#traces format = x\n"
        "#BEGIN_TB\nwarp = 0\ninsts = 40000\n";
    for (int i = 0; i < 40000; ++i) text += "0010 ffffffff 1 R4 LDG.E.SYS 1 R4 4 1 0x7f0000000000 4 0\n";
    const std::string traceg = write("a.traceg", text + "#END_TB\n");

    std::string warp("RTWARP01");
    const auto append = [&](std::uint32_t value) { warp.append(reinterpret_cast<const char*>(&value), 4); };
    for (const std::uint32_t value : {64U, 1U, 8U, 4U, 0U, 1U, 0U, 0U, 64U, 48U, 0U, 0x100U, 0U, 0x200U}) append(value);
    append(300000);
    append(0);
    for (int i = 0; i < 300000; ++i) {
        warp += '\x80';
        append(0xffffffff);
    }
    const std::string rtwarp = write("a.rtwarp", warp);
    const LimitedMemory limit(1 << 20);
    CHECK(mentions(refusal([&] { import_traceg(traceg, folder / "o.rct", {}); }), "loads of its warps"));
    CHECK(mentions(refusal([&] { import_rtwarp(rtwarp, folder / "o.rct", "", ""); }), "its records"));
    CHECK_FALSE(std::filesystem::exists(folder / "o.rct"));
}
