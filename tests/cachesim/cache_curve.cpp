// Equivalent sizes on curves made by hand.
#include "cachesim/analysis/cache_curve.hpp"

#include <catch2/catch.hpp>

#include "cachesim/report/curve_report.hpp"

using namespace raycache;
using namespace raycache::cachesim;

namespace {

/// Caches of 2 sets, 4 ways of their own, that with W ways hit `per_way[launch]` sectors of 100 for each way, up to
/// `most`; ten rays a launch.
LevelCurve curve(const std::vector<std::uint64_t>& per_way, std::uint64_t most) {
    LevelCurve level;
    CurveRow& row = level.rows.emplace_back();
    row.geometry.sets = 2;
    row.geometry.ways = 4;
    for (const std::uint64_t hits : per_way) {
        WaysCurve& launch = row.launches.emplace_back();
        launch.asked = launch.followed = launch.fills = 100;
        for (std::uint64_t sum = 0; sum <= most; sum += hits) launch.hits.push_back(sum);
        level.rays.push_back(10);
        level.asked.push_back(100);
    }
    return level;
}

constexpr std::uint64_t way = 2 * 128;

}  // namespace

TEST_CASE("an equivalent size is the smallest that does as well, exactly where sample indices agree") {
    const LevelCurve base = curve({10, 10}, 90), other = curve({12, 12}, 96);
    for (const DoesAsWell what : {DoesAsWell::bytes_per_ray, DoesAsWell::misses}) {
        const EquivalentSize found = equivalent_size(base, other, what);
        CHECK(found.of == 4 * way);
        CHECK(found.size == 5 * way);  // 48 hits, so 50
        CHECK(found.times() == Approx(1.25));
        CHECK(found.low == 5 * way);
        CHECK(found.high == 5 * way);
    }
    const Estimate bandwidth = equivalent_bandwidth(base, other);
    CHECK(bandwidth.mean == Approx(60.0 / 52));
    CHECK(*bandwidth.half_width == Approx(0).margin(1e-12));
    const EquivalentSize itself = equivalent_size(base, base, DoesAsWell::bytes_per_ray);
    CHECK(itself.size == itself.of);
    CHECK(itself.low == itself.of);
    CHECK(itself.high == itself.of);
}

TEST_CASE("where sample indices differ an equivalent size has an interval around it, and may have no upper end") {
    const EquivalentSize found =
        equivalent_size(curve({1, 1, 1, 1}, 90), curve({11, 9, 12, 8}, 96), DoesAsWell::bytes_per_ray);
    CHECK(found.size == 40 * way);
    CHECK(*found.low < 40 * way);
    CHECK(*found.high > 40 * way);
    const EquivalentSize open = equivalent_size(curve({1, 1}, 90), curve({22, 2}, 96), DoesAsWell::bytes_per_ray);
    CHECK(open.size.has_value());
    CHECK(open.low == way);
    CHECK(!open.high);
}

TEST_CASE("where no size is enough an equivalent size says so, and one sample index gives no interval") {
    const EquivalentSize none = equivalent_size(curve({10, 10}, 40), curve({20, 20}, 90), DoesAsWell::misses);
    CHECK(!none.size);
    CHECK(!none.low);
    const EquivalentSize one = equivalent_size(curve({10}, 90), curve({15}, 90), DoesAsWell::misses);
    CHECK(one.size == 6 * way);
    CHECK(!one.low);
    CHECK(!one.high);
    const Equivalent all{"a", "b", "a", "b", 64, 0, 2, none, one, {1.5, {}}};
    CHECK(to_sentence(all).find("with no size") != std::string::npos);
    CHECK(to_sentence(all).find("with 1.5 KiB (1.5x)") != std::string::npos);
    CHECK(to_sentence(all).find("1.50 times the L2-to-L1 bandwidth of b") != std::string::npos);
}
