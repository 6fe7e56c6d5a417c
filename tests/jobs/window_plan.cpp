// Which blocks of sample indices an estimate draws, and which places in each.
#include "tools/jobs/windows/window_plan.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <map>
#include <set>

using namespace raycache::tools;

namespace {

constexpr std::uint32_t grain = WindowSizes{}.work_warps;

std::set<std::uint32_t> set_of(const std::vector<std::uint32_t>& all, std::size_t begin, std::size_t end) {
    return {all.begin() + static_cast<std::ptrdiff_t>(begin), all.begin() + static_cast<std::ptrdiff_t>(end)};
}

/// How many places each index of the block has.
std::map<std::uint32_t, std::size_t> by_index(const std::vector<WindowPlace>& places) {
    std::map<std::uint32_t, std::size_t> count;
    for (const WindowPlace& place : places) ++count[place.index];
    return count;
}

bool operator==(const WindowPlace& a, const WindowPlace& b) { return a.index == b.index && a.warp == b.warp; }

bool same(const std::vector<WindowPlace>& a, const std::vector<WindowPlace>& b) {
    return a.size() == b.size() &&
           std::equal(a.begin(), a.end(), b.begin(), [](const auto& x, const auto& y) { return x == y; });
}

}  // namespace

TEST_CASE("blocks of an estimate are aligned, and each is drawn once before any is drawn again") {
    const WindowPlan plan(1024, 100, 1, 3);
    CHECK(plan.launches() == 64);
    CHECK(plan.blocks() == 16);
    const std::vector<std::uint32_t> first = plan.draw(40);
    for (const std::uint32_t f : first) {
        CHECK(f % 64 == 0);
        CHECK(f < 1024);
    }
    CHECK(set_of(first, 0, 16).size() == 16);
    CHECK(set_of(first, 16, 32).size() == 16);
    CHECK(set_of(first, 32, 40).size() == 8);
    CHECK(WindowPlan(1024, 100, 1, 3).draw(16) == std::vector(first.begin(), first.begin() + 16));
    CHECK(WindowPlan(1024, 100, 1, 4).draw(40) != first);
}

TEST_CASE("blocks are shorter where there would be fewer than eight of them") {
    CHECK(WindowPlan(512, 100, 1, 1).launches() == 64);
    CHECK(WindowPlan(511, 100, 1, 1).launches() == 32);
    CHECK(WindowPlan(64, 100, 1, 1).launches() == 8);
    CHECK(WindowPlan(8, 100, 1, 1).launches() == 1);
    CHECK(WindowPlan(4, 100, 1, 1).blocks() == 4);
    const WindowPlan hundred(100, 100, 1, 1);
    CHECK(hundred.launches() == 8);
    CHECK(hundred.blocks() == 12);
    for (const std::uint32_t f : hundred.draw(12)) CHECK(f + 8 <= 100);
}

TEST_CASE("of a single sample index every block is that index") {
    const WindowPlan plan(1, 100, 1, 1);
    CHECK(plan.launches() == 1);
    CHECK(plan.draw(3) == std::vector<std::uint32_t>{0, 0, 0});
    for (const WindowPlace& place : plan.block(0, 0).work) CHECK(place.index == 0);
}

TEST_CASE("launches of many sample indices make blocks of as many indices in fewer launches") {
    const WindowPlan plan(1024, 100, 32, 1);
    CHECK(plan.launches() == 2);
    CHECK(plan.blocks() == 16);
    for (const std::uint32_t f : plan.draw(16)) CHECK(f % 64 == 0);
}

TEST_CASE("strategies whose launches hold different numbers of sample indices have the same blocks") {
    for (const std::uint64_t spp : {16, 40, 64, 256, 1024, 10000}) {
        const WindowPlan tiles(spp, 100, 1, 3, {}, 32), samples(spp, 3200, 32, 3, {}, 32);
        CHECK(tiles.blocks() == samples.blocks());
        CHECK(tiles.draw(20) == samples.draw(20));
        CHECK(tiles.launches() == samples.launches() * samples.indices_per_launch());
        CHECK(tiles.launches() == std::min<std::uint64_t>(spp, spp >= 512 ? 64 : 32));
        for (const std::uint32_t first : tiles.draw(20)) {
            CHECK(first % 32 == 0);
            CHECK(first + tiles.launches() <= spp);
        }
    }
}

TEST_CASE("each equal part of the picture has one place, and each index of a block as many as any other") {
    constexpr std::uint32_t warps = 640, groups = 256;
    const WindowPlan plan(1024, warps, 1, 8);
    for (const std::size_t number : {0u, 1u, 5u}) {
        const BlockPlan block = plan.block(number, 128);
        CHECK(block.first == 128);
        REQUIRE(block.work.size() == groups);
        for (std::uint32_t i = 0; i < groups; ++i) {
            const std::uint32_t warp = block.work[i].warp;
            CHECK(warp % grain == 0);
            CHECK(warp < warps);
            // Part i is from i to i + 1 of as many parts of the launch.
            CHECK(warp / grain >= i * (warps / grain) / groups);
            CHECK(warp / grain <= (i + 1) * (warps / grain) / groups);
        }
        for (const auto& [index, count] : by_index(block.work)) CHECK(count == groups / 64);
        CHECK(by_index(block.work).size() == 64);
        CHECK(by_index(block.sm_windows).size() == 64);
        CHECK(block.windows.size() == WindowSizes{}.windows);
        CHECK(by_index(block.windows).size() == block.windows.size());
    }
}

TEST_CASE("windows come in a random order, so that the first few are from anywhere in the picture") {
    const WindowPlan plan(1024, 640, 1, 8);
    std::set<std::uint32_t> eighths;
    for (std::size_t number = 0; number < 40; ++number) eighths.insert(plan.block(number, 0).windows[0].warp / 80);
    CHECK(eighths.size() == 8);
}

TEST_CASE("places are drawn anew for each block and are the same for the same seed and number") {
    const WindowPlan plan(1024, 640, 1, 8);
    CHECK(same(plan.block(2, 0).work, WindowPlan(1024, 640, 1, 8).block(2, 64).work));
    CHECK_FALSE(same(plan.block(2, 0).work, plan.block(3, 0).work));
    CHECK_FALSE(same(plan.block(2, 0).work, WindowPlan(1024, 640, 1, 9).block(2, 0).work));
}

TEST_CASE("every warp of a picture of no whole number of squares is in some traced group") {
    for (const std::uint32_t warps : {1u, 7u, 12u, 21u}) {
        const WindowPlan plan(16, warps, 1, 8);
        std::set<std::uint32_t> traced;
        for (std::size_t number = 0; number < 4; ++number)
            for (const WindowPlace& place : plan.block(number, 0).work)
                for (std::uint32_t i = 0; i < grain && place.warp + i < warps; ++i) traced.insert(place.warp + i);
        CAPTURE(warps);
        CHECK(traced.size() == warps);
    }
}
