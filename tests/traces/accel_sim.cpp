// The reader of Accel-Sim traces, line by line. Expected values are worked out by hand from the grammar.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <map>

#include "files.hpp"
#include "traces/accelsim/import.hpp"
#include "traces/accelsim/traceg_parser.hpp"
#include "traces/accelsim/xz_file.hpp"
#include "traces/reader.hpp"

using namespace raycache::traces;
using Catch::Matchers::Contains;

namespace {

struct Loaded {
    std::uint64_t warp;
    GlobalLoad load;
};

std::string kernel(const std::string& ctas, unsigned grid = 1, unsigned block = 32, const std::string& head = {}) {
    return fmt::format(
        "-kernel name = k\n-grid dim = ({},1,1)\n-block dim = ({},1,1)\n-accelsim tracer version = 5\n{}\n"
        "#traces format = x\n\n{}",
        grid, block, head, ctas);
}

std::string cta(const std::vector<std::string>& instructions, unsigned warp = 0, unsigned x = 0) {
    std::string text =
        fmt::format("#BEGIN_TB\nthread block = {},0,0\nwarp = {}\ninsts = {}\n", x, warp, instructions.size());
    for (const std::string& line : instructions) text += line + '\n';
    return text + "#END_TB\n";
}

void write_text(const std::string& path, const std::string& text) { write_file(path, {text.begin(), text.end()}); }

struct Case {
    TemporaryFolder folder;
    std::string path = folder / "k.traceg";
    TracegKernel found;

    std::vector<Loaded> parse(const std::string& text) {
        write_text(path, text);
        std::vector<Loaded> loads;
        found = parse_traceg(path, [&](std::uint64_t warp, GlobalLoad& load) { loads.push_back({warp, load}); });
        return loads;
    }
    GlobalLoad one(const std::string& instruction) {
        const std::vector<Loaded> loads = parse(kernel(cta({instruction})));
        REQUIRE(loads.size() == 1);
        return loads.front().load;
    }
    std::string refused(const std::string& text) {
        return refusal([&] { parse(text); });
    }
};

using Addresses = std::vector<std::uint64_t>;

}  // namespace

TEST_CASE("the three address modes of a load give the same addresses") {
    Case c;
    const Addresses expected{0x1000, 0x1010, 0x1020};
    const std::string head = "0040 00000070 1 R4 LDG.E.128.SYS 1 R4 16 ";
    for (const char* addresses : {"0 0x1000 0x1010 0x1020 0", "1 0x1000 16 0", "2 0x1000 16 16 0"}) {
        INFO(addresses);
        const GlobalLoad load = c.one(head + addresses);
        CHECK(load.addresses == expected);
        CHECK(load.mask == 0x70);
        CHECK(load.pc == 0x40);
        CHECK(load.bytes == 16);
    }
}

TEST_CASE("differences and strides of addresses may be negative, zero and larger than 32 bits") {
    Case c;
    CHECK(c.one("0 7 1 R4 LDG.E.SYS 1 R4 4 1 0x1000 -4 0").addresses == Addresses{0x1000, 0xffc, 0xff8});
    CHECK(c.one("0 7 1 R4 LDG.E.SYS 1 R4 4 1 0x1000 0 0").addresses == Addresses{0x1000, 0x1000, 0x1000});
    CHECK(c.one("0 15 1 R4 LDG.E.SYS 1 R4 4 2 0x7f0000000000 -136339441844224 8589934592 0").addresses ==
          Addresses{0x7f0000000000, 0x7f0000000000 - 136339441844224, 0x7f0000000000 - 136339441844224 + 8589934592});
}

TEST_CASE("lanes of mode 0 and 2 need not be contiguous, those of mode 1 must be") {
    Case c;
    CHECK(c.one("0 80000001 1 R4 LDG.E.SYS 1 R4 4 0 0x1000 0x2000 0").addresses == Addresses{0x1000, 0x2000});
    CHECK(c.one("0 80000001 1 R4 LDG.E.SYS 1 R4 4 2 0x1000 4096 0").addresses == Addresses{0x1000, 0x2000});
    CHECK_THAT(c.refused(kernel(cta({"0 80000001 1 R4 LDG.E.SYS 1 R4 4 1 0x1000 4096 0"}))),
               Contains("line 12: ") && Contains("contiguous active lanes"));
}

TEST_CASE("the width of a load comes from its opcode") {
    Case c;
    const auto bytes = [&](const std::string& opcode) {
        return c.one("0 1 1 R4 " + opcode + " 1 R4 4 0 0x1000 0").bytes;
    };
    CHECK(bytes("LDG.E.SYS") == 4);
    CHECK(bytes("LDG.E.64.SYS") == 8);
    CHECK(bytes("LDG.E.128.CONSTANT.SYS") == 16);
    CHECK(bytes("LDG.E.U8.SYS") == 1);
    CHECK(bytes("LDG.E.S16.SYS") == 2);
    CHECK(bytes("LDG.E.ENL2.256.CONSTANT") == 32);
    CHECK_THAT(c.refused(kernel(cta({"0 1 1 R4 LDG.E.512.SYS 1 R4 4 0 0x1000 0"}))), Contains("LDG.E.512.SYS"));
}

TEST_CASE("what is no global load is counted by its opcode, and what has no active lane is no access") {
    Case c;
    const auto loads = c.parse(kernel(
        cta({"0 1 0 STG.E.SYS 2 R4 R5 4 0 0x1000 0", "10 1 1 R4 LDS.U.32 1 R4 4 0 0x20 0", "20 0 1 R4 LDG.E.SYS 1 R4 4",
             "30 1 1 R4 IADD3 2 R4 R5 0 0", "40 1 1 R4 LDG.E.STRONG.GPU 1 R4 4 0 0x40 0",
             "44 1 1 R4 LDG.E.STRONG 1 R4 4 0 0x40 0", "50 ffffffff 0 EXIT 0 0 0"})));
    CHECK(loads.size() == 2);
    CHECK(c.found.loads == 2);
    CHECK(c.found.bypassing == 2);
    CHECK(c.found.left_out == std::map<std::string, std::uint64_t>{{"LDS", 1}, {"STG", 1}});
}

TEST_CASE("source line numbers before each instruction are read over where the header says so") {
    Case c;
    const auto loads =
        c.parse(kernel(cta({"17 0040 1 1 R4 LDG.E.SYS 1 R4 4 0 0x1000 0"}), 1, 32, "-enable lineinfo = 1\n"));
    REQUIRE(loads.size() == 1);
    CHECK(loads.front().load.pc == 0x40);
}

TEST_CASE("a warp's number is that of its CTA times the warps of a CTA plus its own, and warps may be left out") {
    Case c;
    const std::string load = "0 1 1 R4 LDG.E.SYS 1 R4 4 0 0x1000 0";
    const auto loads = c.parse(kernel(cta({load}, 2) + cta({load}, 0), 2, 65));
    REQUIRE(loads.size() == 2);
    CHECK(c.found.warps_per_cta == 3);
    CHECK(loads[0].warp == 2);
    CHECK(loads[1].warp == 3);
}

TEST_CASE("thread blocks that the file leaves out have no loads, and those it has keep their numbers") {
    Case c;
    const std::string load = "0 1 1 R4 LDG.E.SYS 1 R4 4 0 0x1000 0";
    const auto loads = c.parse(kernel(cta({load}) + cta({load}, 0, 2), 4));
    REQUIRE(loads.size() == 2);
    CHECK(loads[0].warp == 0);
    CHECK(loads[1].warp == 2);
    CHECK(c.found.ctas == 4);
    CHECK(c.found.empty_ctas == 2);
}

TEST_CASE("a file with more thread blocks than the grid, with none, or with some of them in disorder is refused") {
    Case c;
    const std::string one = cta({"0 1 1 R4 LDG.E.SYS 1 R4 4 0 0x1000 0"});
    CHECK_THAT(c.refused(kernel(one + one, 1)), Contains("no more than 1"));
    CHECK_THAT(c.refused(kernel("", 2)), Contains("thread blocks of a grid of 2, found none"));
    CHECK_THAT(c.refused(kernel(cta({}, 0, 2) + one, 3)),
               Contains("3 thread blocks") && Contains("2 in another order"));
    CHECK_THAT(c.refused(kernel(cta({}, 0, 3), 3)), Contains("below 3,1,1"));
}

TEST_CASE("a file with all thread blocks in another order numbers them by their places") {
    Case c;
    const std::string load = "0 1 1 R4 LDG.E.SYS 1 R4 4 0 0x1000 0";
    write_text(c.path, kernel(cta({load}, 0, 1) + cta({load}, 0, 0), 2));
    std::vector<std::uint64_t> warps;
    CHECK_FALSE(parse_traceg(c.path, [&](std::uint64_t, GlobalLoad&) {}).in_order);
    parse_traceg(c.path, [&](std::uint64_t warp, GlobalLoad&) { warps.push_back(warp); }, {NullLanes::keep, true});
    CHECK(warps == std::vector<std::uint64_t>{0, 1});
}

TEST_CASE("a compressed trace that is cut or damaged anywhere is refused, and the whole one reads like the plain one") {
    Case c;
    std::vector<std::string> instructions;
    for (unsigned i = 0; i < 2000; ++i)
        instructions.push_back(
            fmt::format("{:x} 1 1 R4 LDG.E.SYS 1 R4 4 0 {:#x} 0", 16 * i, 4096 + 4 * ((i * 7919) % 65536)));
    const std::string text = kernel(cta(instructions));
    const std::string compressed = c.folder / "k.traceg.xz";
    {
        XzFile file(compressed);
        file.write(text);
        file.commit();
    }
    const auto plain = c.parse(text);
    std::size_t same = 0;
    parse_traceg(compressed,
                 [&](std::uint64_t, GlobalLoad& load) { same += load.addresses == plain[same].load.addresses; });
    CHECK(same == 2000);

    const std::vector<std::uint8_t> bytes = read_file(compressed);
    const auto refused = [&](const std::vector<std::uint8_t>& damaged) {
        const std::string path = c.folder / "damaged.traceg.xz";
        write_file(path, damaged);
        return !refusal([&] { parse_traceg(path, [](std::uint64_t, GlobalLoad&) {}); }).empty();
    };
    std::vector<std::size_t> missed_cuts, missed_flips;
    for (std::size_t size = 0; size < bytes.size(); size += 97)
        if (!refused({bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size)})) missed_cuts.push_back(size);
    for (std::size_t at = 0; at < bytes.size(); at += 89) {
        auto damaged = bytes;
        damaged[at] ^= 0x10;
        if (!refused(damaged)) missed_flips.push_back(at);
    }
    CHECK(missed_cuts.empty());
    CHECK(missed_flips.empty());
}

TEST_CASE("loads that read on become one object, up to 4096 bytes") {
    Case c;
    const auto objects = [&](unsigned loads, unsigned step, Fuse fuse) {
        std::vector<std::string> instructions;
        for (unsigned i = 0; i < loads; ++i)
            instructions.push_back(fmt::format("{:x} 3 1 R4 LDG.E.128.SYS 1 R4 16 0 {:#x} {:#x} 0", 16 * i,
                                               0x200000 + step * i, 0x400000 + step * i));
        write_text(c.path, kernel(cta(instructions)));
        const std::string out = c.folder / "out.rct";
        ImportSettings settings;
        settings.fuse = fuse;
        import_traceg(c.path, out, settings);
        std::vector<std::uint32_t> sizes;
        const Reader reader(out);
        std::vector<WarpTrace> warps;
        reader.read_block(0, warps);
        for (const Record& record : warps.front().records)
            if (record.is_access()) sizes.push_back(reader.header().regions[record.region].element_size);
        return sizes;
    };
    CHECK(objects(4, 16, Fuse::always) == std::vector<std::uint32_t>{64});
    CHECK(objects(4, 16, Fuse::never) == std::vector<std::uint32_t>{16, 16, 16, 16});
    CHECK(objects(4, 32, Fuse::always) == std::vector<std::uint32_t>{16, 16, 16, 16});
    CHECK(objects(256, 16, Fuse::always) == std::vector<std::uint32_t>{4096});
    CHECK(objects(257, 16, Fuse::always) == std::vector<std::uint32_t>{4096, 16});
}
