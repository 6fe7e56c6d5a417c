// What a file is taken for by its first bytes, and what is said of files that are no traces.
#include <catch2/catch.hpp>
#include <string>

#include "files.hpp"
#include "traces/addresses/guess.hpp"
#include "traces/bytes.hpp"

using namespace raycache::traces;
using Catch::Matchers::Contains;

TEST_CASE("a file of another kind is refused by what it looks like") {
    const TemporaryFolder folder;
    const std::string path = folder / "k.traceg";
    const auto guess = [&](const std::string& text) {
        write_file(path, {text.begin(), text.end()});
        return guess_trace_kind(path);
    };
    CHECK(guess("0 7f5000000000\n1 20\n") == TraceKind::dinero);
    CHECK(guess("time,obj,size\n") == TraceKind::csv);
    CHECK(guess("RTWARP01....") == TraceKind::rtwarp);
    CHECK(guess("-kernel name = k\n-grid dim = (1,1,1)\n-block dim = (32,1,1)\n-accelsim tracer version = 5\n") ==
          TraceKind::accel_sim);
    CHECK(guess("kernel-1.traceg.xz\n") == TraceKind::accel_sim);
    const auto says = [&](const std::string& text) { return refusal([&] { guess(text); }); };
    CHECK_THAT(says(""), Contains("an empty file"));
    CHECK_THAT(says("I  04001090,3\n L 1ffefffe50,8\n"), Contains("Lackey"));
    CHECK_THAT(says("==12== Lackey, an example Valgrind tool\n"), Contains("Lackey"));
    CHECK_THAT(says("------ NVBit ------\nMEMTRACE: CTX 0x1 - LDG.E - 0x10\n"), Contains("mem_trace"));
    CHECK_THAT(says(std::string("RCTRACE\x1a\x02\0\0\0", 12)), Contains("a trace of raycache"));
    std::string oracle;
    for (unsigned i = 1; i < 100; ++i) {
        Bytes record;
        append(record, i / 3);
        append(record, std::uint64_t{i * 7919});
        append(record, std::uint32_t{4096});
        append(record, ~std::uint64_t{0});
        oracle.append(record.begin(), record.end());
    }
    CHECK_THAT(says(oracle), Contains("oracleGeneral"));
    CHECK_THAT(says(std::string("\x40\0\0\0\x50\x7f\0\0\x40\0\0\0\x50\x7f\0\0", 16)), Contains("--format u64"));
    CHECK_THAT(says("once upon a time\n"), Contains("text of another kind"));
}
