#include <catch2/catch.hpp>

#include "files.hpp"
#include "samples.hpp"
#include "traces/reader.hpp"
#include "traces/verify.hpp"

using namespace raycache::traces;
using Catch::Matchers::Contains;

namespace {

struct Case {
    TemporaryFolder folder;
    std::string whole = folder / "whole.rct", damaged = folder / "damaged.rct", saved = folder / "saved.rct";
    Sample sample = bvh_walks({1, 2, 30, 3, 4});
    std::vector<std::uint8_t> bytes;
    std::vector<BlockInfo> blocks;

    Case() {
        write_sample(sample, whole, 2);
        bytes = read_file(whole);
        blocks = Reader(whole).blocks();
    }
    RecoverResult run() {
        write_file(damaged, bytes);
        return recover(damaged, saved);
    }
};

}  // namespace

TEST_CASE("a whole trace is recovered as it is") {
    Case c;
    const RecoverResult result = c.run();
    CHECK(result.launches_kept == 3);
    CHECK(result.launches_lost == 0);
    CHECK(result.blocks_kept == 6);
    CHECK(result.blocks_lost == 0);
    CHECK(read_file(c.saved) == c.bytes);
}

TEST_CASE("a trace without its index keeps its whole launches") {
    Case c;
    c.bytes.resize(c.blocks[5].offset + c.blocks[5].bytes - 1);
    const RecoverResult result = c.run();
    CHECK(result.launches_kept == 2);
    CHECK(result.launches_lost == 1);
    CHECK(result.blocks_kept == 4);
    CHECK(result.blocks_lost == 2);
    CHECK(verify(c.saved).warps == 8);
    CHECK(Reader(c.saved).header().launches == std::vector<std::uint32_t>{0, 7});
}

TEST_CASE("a damaged launch in the middle is left out and the rest is renumbered") {
    Case c;
    c.bytes[c.blocks[2].offset + 130] ^= 1;
    const RecoverResult result = c.run();
    CHECK(result.launches_kept == 2);
    CHECK(result.blocks_lost == 2);
    CHECK(Reader(c.saved).header().launches == std::vector<std::uint32_t>{0, 14});
    const auto warps = read_all(c.saved);
    REQUIRE(warps.size() == 8);
    CHECK(warps[5].launch == 1);
    CHECK(warps[5].records == c.sample.warps[9].records);
    CHECK(warps[5].elements == c.sample.warps[9].elements);
}

TEST_CASE("bytes lost or added between blocks do not hide the blocks behind them") {
    Case c;
    const auto at = c.bytes.begin() + static_cast<std::ptrdiff_t>(c.blocks[2].offset);
    c.bytes.insert(at, 3000000, std::uint8_t{'R'});
    CHECK(c.run().launches_kept == 3);
    CHECK(read_all(c.saved) == c.sample.warps);
}

TEST_CASE("a trace without one whole launch cannot be recovered") {
    Case c;
    c.bytes.resize(c.blocks[1].offset);
    CHECK_THAT(refusal([&] { c.run(); }), Contains("no complete launch among 3"));
    CHECK(!std::filesystem::exists(c.saved));
    c.bytes[20] ^= 1;
    CHECK_THAT(refusal([&] { c.run(); }), Contains("head"));
}
