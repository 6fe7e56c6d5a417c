// Thread maps: who traces which pixel and sample.
#include <algorithm>
#include <catch2/catch.hpp>
#include <map>
#include <set>
#include <tuple>
#include <vector>

#include "tracer/simt/thread_map.hpp"
#include "traces/error.hpp"

using namespace raycache;
using namespace raycache::tracer;

namespace {

constexpr std::pair<std::uint32_t, std::uint32_t> sizes[] = {{1, 1},  {17, 33}, {512, 512}, {16, 16},
                                                             {15, 1}, {1, 100}, {33, 8}};

}  // namespace

TEST_CASE("thread map: tile gives every pixel exactly once, whatever the size of the picture", "[slow]") {
    for (const auto& [width, height] : sizes) {
        const LaunchGrid grid(ThreadMap::tile, width, height, 8);
        CHECK(grid.samples_per_launch() == 1);
        std::vector<int> count(std::size_t{width} * height);
        for (std::uint32_t warp = 0; warp < grid.warps(); ++warp) {
            const WarpJobs jobs = grid.jobs(warp, 5);
            for (unsigned l = 0; l < 32; ++l) {
                if (((jobs.mask >> l) & 1U) == 0) continue;
                REQUIRE(jobs.lane[l].x < width);
                REQUIRE(jobs.lane[l].y < height);
                REQUIRE(jobs.lane[l].sample == 5);
                ++count[std::size_t{jobs.lane[l].y} * width + jobs.lane[l].x];
            }
        }
        bool once = true;
        for (const int n : count) once = once && n == 1;
        INFO(width << "x" << height);
        CHECK(once);
    }
}

TEST_CASE("thread map: a warp of tile is 8x4 pixels, row by row") {
    const LaunchGrid grid(ThreadMap::tile, 512, 512, 1);
    CHECK(grid.warps() == 512 * 512 / 32);
    for (std::uint32_t warp = 0; warp < grid.warps(); ++warp) {
        const WarpJobs jobs = grid.jobs(warp, 0);
        REQUIRE(jobs.mask == ~0U);
        REQUIRE(jobs.lane[0].x % 8 == 0);
        REQUIRE(jobs.lane[0].y % 4 == 0);
        for (unsigned l = 0; l < 32; ++l) {
            REQUIRE(jobs.lane[l].x == jobs.lane[0].x + l % 8);
            REQUIRE(jobs.lane[l].y == jobs.lane[0].y + l / 8);
        }
    }
}

TEST_CASE("thread map: eight warps in a row make a square of 16x16 pixels, squares follow row by row") {
    const LaunchGrid grid(ThreadMap::tile, 64, 48, 1);
    for (std::uint32_t warp = 0; warp < grid.warps(); ++warp)
        for (const LaneJob& job : grid.jobs(warp, 0).lane) {
            REQUIRE(job.x / 16 == warp / 8 % 4);
            REQUIRE(job.y / 16 == warp / 8 / 4);
        }
}

TEST_CASE("thread map: rows gives a warp 32 pixels that follow one another along the rows, every pixel once") {
    for (const auto& [width, height] : sizes) {
        const LaunchGrid grid(ThreadMap::rows, width, height, 8);
        CHECK(grid.samples_per_launch() == 1);
        std::uint32_t next = 0;
        for (std::uint32_t warp = 0; warp < grid.warps(); ++warp) {
            const WarpJobs jobs = grid.jobs(warp, 5);
            REQUIRE(jobs.mask != 0);
            for (unsigned l = 0; l < 32 && next < width * height; ++l, ++next) {
                REQUIRE((jobs.mask >> l & 1U) == 1);
                REQUIRE(jobs.lane[l].x == next % width);
                REQUIRE(jobs.lane[l].y == next / width);
                REQUIRE(jobs.lane[l].sample == 5);
            }
        }
        CHECK(next == width * height);
        CHECK(grid.jobs(0, 8).mask == 0);  // N is 8
    }
}

TEST_CASE("thread map: samples gives a warp one pixel and 32 consecutive samples, every pixel once", "[slow]") {
    for (const auto& [width, height] : sizes) {
        const LaunchGrid grid(ThreadMap::samples, width, height, 64);
        CHECK(grid.samples_per_launch() == 32);
        std::set<std::pair<std::uint32_t, std::uint32_t>> seen;
        for (std::uint32_t warp = 0; warp < grid.warps(); ++warp) {
            const WarpJobs jobs = grid.jobs(warp, 32);
            if (jobs.mask == 0) continue;
            REQUIRE(jobs.mask == ~0U);
            unsigned in_place = 0;  // one assertion a warp: there are a million lanes
            for (unsigned l = 0; l < 32; ++l)
                in_place += jobs.lane[l].x == jobs.lane[0].x && jobs.lane[l].y == jobs.lane[0].y &&
                            jobs.lane[l].sample == 32 + l;
            REQUIRE(in_place == 32);
            REQUIRE(seen.insert({jobs.lane[0].x, jobs.lane[0].y}).second);
        }
        CHECK(seen.size() == std::size_t{width} * height);
    }
}

TEST_CASE("thread map: with samples, lanes beyond N have no work") {
    const LaunchGrid few(ThreadMap::samples, 4, 4, 5);
    CHECK(few.jobs(0, 0).mask == 0b11111U);
    const LaunchGrid more(ThreadMap::samples, 4, 4, 40);
    CHECK(more.jobs(0, 0).mask == ~0U);
    CHECK(more.jobs(0, 32).mask == 0xffU);
}

TEST_CASE("thread map: samples visits pixels in the order of tile") {
    const LaunchGrid tile(ThreadMap::tile, 48, 32, 32), samples(ThreadMap::samples, 48, 32, 32);
    for (std::uint32_t warp = 0; warp < tile.warps(); ++warp)
        for (unsigned l = 0; l < 32; ++l) {
            const LaneJob a = tile.jobs(warp, 0).lane[l], b = samples.jobs(32 * warp + l, 0).lane[0];
            REQUIRE((a.x == b.x && a.y == b.y));
        }
}

TEST_CASE("thread map: classes gives every pixel exactly once, and a warp pixels of one class, for any size and m") {
    for (const auto& [width, height] : sizes)
        for (const std::uint32_t m : {1U, 2U, 3U, 8U, 15U, 256U}) {
            if (m > std::min(width, height)) {
                if (m > 1) CHECK_THROWS_AS(LaunchGrid(ThreadMap::classes, width, height, 8, m), UsageError);
                continue;
            }
            const LaunchGrid grid(ThreadMap::classes, width, height, 8, m);
            CHECK(grid.samples_per_launch() == 1);
            std::vector<int> count(std::size_t{width} * height);
            std::uint32_t last_class = 0;
            bool one_class = true, in_order = true;
            for (std::uint32_t warp = 0; warp < grid.warps(); ++warp) {
                const WarpJobs jobs = grid.jobs(warp, 5);
                std::set<std::uint32_t> classes;
                for (unsigned l = 0; l < 32; ++l) {
                    if (((jobs.mask >> l) & 1U) == 0) continue;
                    classes.insert(jobs.lane[l].y % m * m + jobs.lane[l].x % m);
                    ++count.at(std::size_t{jobs.lane[l].y} * width + jobs.lane[l].x);
                }
                if (classes.empty()) continue;
                one_class = one_class && classes.size() == 1;
                in_order = in_order && *classes.begin() >= last_class;
                last_class = *classes.begin();
            }
            INFO(width << "x" << height << " m " << m);
            CHECK(one_class);
            CHECK(in_order);
            CHECK(std::count(count.begin(), count.end(), 1) == static_cast<std::ptrdiff_t>(count.size()));
        }
}

TEST_CASE("thread map: a warp of classes is 8x4 pixels that lie m apart, and m = 1 is tile") {
    const LaunchGrid grid(ThreadMap::classes, 512, 512, 1, 8), tile(ThreadMap::tile, 512, 512, 1);
    CHECK(grid.warps() == 512 * 512 / 32);
    const WarpJobs jobs = grid.jobs(grid.warps() / 64 * 9, 0);  // first warp of class (1, 1)
    for (unsigned l = 0; l < 32; ++l) {
        CHECK(jobs.lane[l].x == 1 + 8 * (l % 8));
        CHECK(jobs.lane[l].y == 1 + 8 * (l / 8));
    }
    const LaunchGrid whole(ThreadMap::classes, 512, 512, 1, 1);
    REQUIRE(whole.warps() == tile.warps());
    for (std::uint32_t warp = 0; warp < tile.warps(); ++warp)
        for (unsigned l = 0; l < 32; l += 31)
            REQUIRE((whole.jobs(warp, 0).lane[l].x == tile.jobs(warp, 0).lane[l].x &&
                     whole.jobs(warp, 0).lane[l].y == tile.jobs(warp, 0).lane[l].y));
}

TEST_CASE("thread map: more classes than the picture's shorter side has pixels, or none, are refused in one line") {
    CHECK_THROWS_WITH(LaunchGrid(ThreadMap::classes, 64, 4, 8, 8),
                      Catch::Contains("8x8 classes") && Catch::Contains("64x4") && !Catch::Contains("\n"));
    CHECK_THROWS_AS(LaunchGrid(ThreadMap::classes, 64, 64, 8, 0), UsageError);
    CHECK_NOTHROW(LaunchGrid(ThreadMap::tile, 64, 4, 8, 8));  // m plays no part
}

TEST_CASE("thread map: the name of a grid gives the same grid again, and no other name gives one") {
    for (const LaunchGrid& grid : {LaunchGrid(ThreadMap::tile, 50, 40, 9), LaunchGrid(ThreadMap::samples, 50, 40, 9),
                                   LaunchGrid(ThreadMap::classes, 50, 40, 9, 3)}) {
        const auto again = LaunchGrid::from_name(grid.name(), 50, 40, 9);
        REQUIRE(again);
        CHECK(again->name() == grid.name());
        REQUIRE(again->warps() == grid.warps());
        for (std::uint32_t warp = 0; warp < grid.warps(); ++warp) {
            CHECK(again->jobs(warp, 0).mask == grid.jobs(warp, 0).mask);
            CHECK(again->jobs(warp, 0).lane[5].x == grid.jobs(warp, 0).lane[5].x);
        }
    }
    CHECK(LaunchGrid(ThreadMap::classes, 50, 40, 9, 3).name() == "classes:3");
    for (const char* name : {"", "tiles", "classes", "classes:", "classes:0", "classes:41", "classes:3x", "classes:-3"})
        CHECK_FALSE(LaunchGrid::from_name(name, 50, 40, 9));
}

TEST_CASE("thread map: a name gives its map, another one is refused with the list") {
    for (const ThreadMap map : {ThreadMap::tile, ThreadMap::samples, ThreadMap::rows, ThreadMap::classes})
        CHECK(thread_map_from(to_string(map)) == map);
    CHECK_THROWS_AS(thread_map_from("tiles"), UsageError);
    CHECK_THROWS_WITH(thread_map_from(""), Catch::Contains("tile, samples, rows, classes") && !Catch::Contains("\n"));
}
