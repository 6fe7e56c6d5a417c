// What imports of instructions say of a warp's waits: by hand from the registers of each line.
#include <fmt/format.h>

#include <catch2/catch.hpp>

#include "files.hpp"
#include "samples.hpp"
#include "traces/accelsim/import.hpp"
#include "traces/bytes.hpp"
#include "traces/reader.hpp"
#include "traces/verify.hpp"

using namespace raycache::traces;
using Catch::Matchers::Contains;

namespace {

using Steps = std::vector<IssueStep>;

struct Import {
    TemporaryFolder folder;
    std::string path = folder / "k.traceg", out = folder / "k.rct";
    ImportSettings settings;

    /// The first warp of a kernel of one warp with these instructions.
    WarpTrace warp(const std::vector<std::string>& lines) {
        std::string text = fmt::format(
            "-kernel name = k\n-grid dim = (1,1,1)\n-block dim = (32,1,1)\n-accelsim tracer version = 5\n\n#traces "
            "format "
            "= x\n\n#BEGIN_TB\nthread block = 0,0,0\nwarp = 0\ninsts = {}\n",
            lines.size());
        for (const std::string& line : lines) text += line + '\n';
        text += "#END_TB\n";
        write_file(path, {text.begin(), text.end()});
        import_traceg(path, out, settings);
        verify(out);
        return read_all(out).front();
    }
    Steps steps(const std::vector<std::string>& lines) { return warp(lines).issue; }
};

/// A load of 4 bytes to register `to` by address register `from`.
std::string load(const std::string& to, const std::string& from, unsigned pc = 0) {
    return fmt::format("{:x} 1 1 {} LDG.E 1 {} 4 0 {:#x} 0", pc, to, from, 0x1000 + 0x100 * pc);
}

std::uint32_t load_u32(const std::vector<std::uint8_t>& bytes, std::size_t at) {
    return raycache::traces::load<std::uint32_t>(bytes.data() + at);
}

const std::string end = "f0 ffffffff 0 EXIT 0 0 0";

}  // namespace

TEST_CASE("independent loads wait for nothing, and what uses them waits for both") {
    Import import;
    CHECK(import.steps({load("R8", "R2"), load("R12", "R4"), "20 1 1 R20 FADD 2 R8 R12 0 0", load("R16", "R20"),
                        end}) == Steps{{2, 1, 0}, {2, 2, 1}, {3, 0, 0}});
}

TEST_CASE("a load waits for the one that loads its address, or the upper half of it") {
    Import import;
    CHECK(import.steps({load("R4", "R4"), load("R4", "R4"), end}) == Steps{{1, 1, 0}, {2, 0, 0}});
    CHECK(import.steps({load("R11", "R2"), load("R20", "R10"), end}) == Steps{{1, 1, 0}, {2, 0, 0}});
    CHECK(import.steps({load("R12", "R2"), load("R20", "R10"), end}) == Steps{{2, 0, 0}});
}

TEST_CASE("a warp issues in order: an instruction that waits holds up a load that does not") {
    Import import;
    CHECK(import.steps({load("R8", "R2"), "10 1 1 R20 IADD3 1 R30 0 0", "20 1 1 R21 IADD3 1 R30 0 0",
                        "30 1 1 R22 FMUL 1 R8 0 0", "40 1 1 R22 FMUL 1 R8 0 0", load("R16", "R4"), end}) ==
          Steps{{1, 0, 2}, {1, 1, 2}, {2, 0, 0}});
}

TEST_CASE("a register that is loaded again, or computed, waits for the load before") {
    Import import;
    CHECK(import.steps({load("R8", "R2"), load("R8", "R4"), end}) == Steps{{1, 1, 0}, {2, 0, 0}});
    CHECK(import.steps({load("R8", "R2"), "10 1 1 R8 MOV 1 R30 0 0", load("R9", "R8"), end}) ==
          Steps{{1, 1, 1}, {2, 0, 0}});
}

TEST_CASE("all registers of a wide load are late, those of an object that is one access together") {
    Import import;
    const std::string wide = "0 1 1 R8 LDG.E.128 1 R2 16 0 0x1000 0", next = "10 1 1 R12 LDG.E.128 1 R2 16 0 0x1010 0";
    CHECK(import.steps({wide, "20 1 1 R20 FADD 1 R11 0 0", end}) == Steps{{1, 1, 1}});
    CHECK(import.steps({wide, "20 1 1 R20 FADD 1 R12 0 0", end}) == Steps{{1, 0, 1}});
    CHECK(import.steps({wide, next, "20 1 1 R20 FADD 1 R9 0 0", "30 1 1 R20 FADD 1 R14 0 0", end}) == Steps{{1, 1, 2}});
    import.settings.fuse = Fuse::never;
    CHECK(import.steps({wide, next, "20 1 1 R20 FADD 1 R9 0 0", "30 1 1 R20 FADD 1 R14 0 0", end}) ==
          Steps{{2, 1, 1}, {2, 2, 1}});
    import.settings.fuse = Fuse::always;  // the second one's address is what the first one loads
    CHECK(import.steps({wide, "10 1 1 R12 LDG.E.128 1 R8 16 0 0x1010 0", "20 1 1 R20 FADD 1 R14 0 0", end}) ==
          Steps{{1, 1, 1}});
}

TEST_CASE("RZ, uniform registers and predicates are no loads' registers") {
    Import import;
    CHECK(import.steps({load("RZ", "R2"), load("R255", "R2"), "20 1 1 R20 FADD 4 RZ R255 UR8 P3 0 0", end}) ==
          Steps{{2, 0, 1}});
    CHECK(import.steps({load("R3", "R8"), "20 1 1 P3 ISETP 2 UR3 UP3 0 0", end}) == Steps{{1, 0, 1}});
    for (const char* wrong : {"R256", "Q4", "UR", "P-1", "R", "U4", "R4.reuse"})
        CHECK_THAT(refusal([&] {
                       import.steps({"0 1 1 R20 FADD 1 " + std::string(wrong) + " 0 0", load("R8", "R2")});
                   }),
                   Contains("line 12: register: expected R, UR or P and a number up to 255, found") && Contains(wrong));
}

TEST_CASE("a store waits for its data, and nothing for it; left out, it is one more instruction") {
    Import import;
    const std::vector<std::string> lines{load("R8", "R2"), "10 1 0 STG.E 2 R4 R8 4 0 0x2000 0", load("R16", "R2", 2),
                                         end};
    CHECK(import.steps(lines) == Steps{{1, 1, 1}, {2, 0, 0}});
    import.settings.stores = true;
    CHECK(import.steps(lines) == Steps{{1, 1, 0}, {3, 0, 0}});
}

TEST_CASE("copies to shared memory are waited for by group") {
    Import import;
    const auto copy = [](unsigned pc) {
        return fmt::format("{:x} 1 0 LDGSTS.E.128 2 R17 R22 16 0 {:#x} 0", pc, 0x5000 + 16 * pc);
    };
    const std::string ends = "0 ffffffff 0 LDGDEPBAR 0 0 0";
    CHECK(import.steps({copy(1), ends, copy(3), copy(5), ends, "0 ffffffff 0 DEPBAR.LE 0 0 1",
                        "0 ffffffff 0 DEPBAR.LE 0 0 0x0", end}) ==
          Steps{{1, 0, 1}, {3, 0, 1}, {3, 1, 1}, {3, 2, 0}, {3, 3, 1}});
}

TEST_CASE("loads that are left out are instructions, and a warp that loads nothing has no steps") {
    Import import;
    CHECK(import.steps({load("R8", "R2"), "10 1 1 R9 LDG.E 1 R8 4 0 0x0 0", "20 0 1 R9 LDG.E 1 R2 4", end}) ==
          Steps{{1, 1, 2}});
    CHECK(import.steps({load("R8", "R2")}) == Steps{{1, 0, 0}});
}

TEST_CASE("the EXIT that ends a warp is no step, one of some lanes is") {
    Import import;
    CHECK(import.steps({load("R8", "R2"), end}) == Steps{{1, 0, 0}});
    CHECK(import.steps({load("R8", "R2"), "10 2 0 EXIT 0 0 0", load("R9", "R2"), end}) == Steps{{1, 0, 1}, {2, 0, 0}});
    CHECK(import.steps({load("R8", "R2"), "10 2 0 EXIT 0 0 0", "20 1 1 R9 MOV 1 R3 0 0", end}) == Steps{{1, 0, 2}});
}

TEST_CASE("as visits of a traversal, loads are a trace that older readers know") {
    Import import;
    const std::vector<std::string> lines{load("R8", "R2"), load("R12", "R4"), end};
    const WarpTrace with = import.warp(lines);
    CHECK(load_u32(read_file(import.out), 8) == 4);
    CHECK(Reader(import.out).header().issue);
    import.settings.traversal = true;
    const WarpTrace without = import.warp(lines);
    CHECK(load_u32(read_file(import.out), 8) == 1);
    CHECK(without.issue.empty());
    CHECK(without.records == with.records);
    CHECK(without.elements == with.elements);
}

TEST_CASE("issue steps come back exactly, and those that break a rule are refused when written") {
    const TemporaryFolder folder;
    Sample sample = bvh_walks({7, 2, 40, 2, 5});
    sample.header.issue = true;
    Random random(3);
    for (WarpTrace& warp : sample.warps) {
        std::uint32_t accesses = 0;
        const auto step = [&] {
            warp.issue.push_back(
                {accesses, random.below(accesses + 1), random.chance(10) ? random.bits() : random.below(9)});
        };
        for (const Record& record : warp.records) {
            if (!record.is_access()) continue;
            for (unsigned n = random.below(3); n > 0; --n) step();
            ++accesses;
        }
        if (accesses > 0) step();
    }
    write_sample(sample, folder / "t.rct");
    CHECK(read_all(folder / "t.rct") == sample.warps);
    CHECK_NOTHROW(verify(folder / "t.rct"));
    recover(folder / "t.rct", folder / "recovered.rct");
    CHECK(read_all(folder / "recovered.rct") == sample.warps);
    CHECK(Reader(folder / "recovered.rct").header() == sample.header);

    const auto refused = [&](auto change) {
        Sample bad = sample;
        change(bad.warps[0].issue);
        return refusal([&] { write_sample(bad, folder / "bad.rct"); });
    };
    CHECK_THAT(refused([](Steps& s) { s.back().access += 1; }), Contains("order of the accesses"));
    CHECK_THAT(refused([](Steps& s) { s.pop_back(); }), Contains("behind all accesses"));
    CHECK_THAT(refused([](Steps& s) { s.clear(); }), Contains("behind all accesses"));
    CHECK_THAT(refused([](Steps& s) { s[0].needs = s[0].access + 1; }), Contains("an access before it"));
    CHECK_THAT(refused([](Steps& s) { s.resize(3 * s.back().access + 9, s.back()); }), Contains("two issue steps"));
    sample.header.issue = false;
    CHECK_THAT(refused([](Steps&) {}), Contains("no issue steps"));
}
