// Star discrepancy against hand-computed sets and a brute-force count of every critical box.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <vector>

#include "tracer/sampling/measures/star_discrepancy.hpp"
#include "tracer/sampling/sequence.hpp"
#include "traces/error.hpp"

using namespace raycache;
using namespace raycache::tracer;

namespace {

constexpr std::uint32_t half = 0x80000000U;

std::vector<FixedPoint2> base_points(const std::string& name, std::uint32_t n) {
    const auto sequence = make_sequence(name);
    std::vector<FixedPoint2> points;
    for (std::uint32_t i = 0; i < n; ++i) points.push_back({sequence->sample(i, 0), sequence->sample(i, 1)});
    return points;
}

/// Counts the points of every box with edges at points or 1, closed and open.
double brute_force(const std::vector<FixedPoint2>& points) {
    std::vector<double> xs{1}, ys{1};
    for (const auto& p : points) {
        xs.push_back(p.x * 0x1p-32);
        ys.push_back(p.y * 0x1p-32);
    }
    double worst = 0;
    for (const double x : xs) {
        for (const double y : ys) {
            int open = 0, closed = 0;
            for (const auto& p : points) {
                open += p.x * 0x1p-32 < x && p.y * 0x1p-32 < y;
                closed += p.x * 0x1p-32 <= x && p.y * 0x1p-32 <= y;
            }
            const auto n = static_cast<double>(points.size());
            worst = std::max({worst, x * y - open / n, closed / n - x * y});
        }
    }
    return worst;
}

}  // namespace

TEST_CASE("star discrepancy: sets small enough to do by hand") {
    CHECK(star_discrepancy(std::vector<FixedPoint2>{{0, 0}}) == 1.0);         // the box [0,e) x [0,e) holds everything
    CHECK(star_discrepancy(std::vector<FixedPoint2>{{half, half}}) == 0.75);  // closed box of area 1/4 holds all
    CHECK(star_discrepancy(std::vector<FixedPoint2>{{0, 0}, {half, half}}) == 0.75);  // closed box [0,1/2]^2 holds all
    CHECK(star_discrepancy(std::vector<FixedPoint2>{{half, half}, {half, half}, {half, half}}) == 0.75);
    // All points on one line x = 1/2 at heights 1/4 and 3/4: the open box left of them is empty, 1/2; the closed box up
    // to 3/4 holds all of an area of 3/8.
    CHECK(star_discrepancy(std::vector<FixedPoint2>{{half, half / 2}, {half, half + half / 2}}) == 0.625);
}

TEST_CASE("star discrepancy: equals the brute-force count for random sets, with and without shared coordinates") {
    std::mt19937 random(7);
    for (int round = 0; round < 40; ++round) {
        const std::uint32_t mask = round % 2 == 0 ? ~0U : 0xE0000000U;  // 8 different coordinates only
        std::vector<FixedPoint2> points(1 + random() % 40);
        for (auto& p : points)
            p = {static_cast<std::uint32_t>(random()) & mask, static_cast<std::uint32_t>(random()) & mask};
        CHECK(star_discrepancy(points) == Approx(brute_force(points)).margin(1e-14));
    }
    for (const std::string name : {"sobol", "halton"})
        for (const std::uint32_t n : {16U, 100U}) {
            const auto points = base_points(name, n);
            CHECK(star_discrepancy(points) == Approx(brute_force(points)).margin(1e-14));
        }
}

TEST_CASE("star discrepancy: the order of the points and a swap of the axes do not matter") {
    auto points = base_points("halton", 200);
    const double first = star_discrepancy(points);
    std::shuffle(points.begin(), points.end(), std::mt19937(3));
    CHECK(star_discrepancy(points) == first);
    for (auto& p : points) std::swap(p.x, p.y);
    CHECK(star_discrepancy(points) == Approx(first).margin(1e-15));
}

TEST_CASE("star discrepancy: 128 Halton points give the K of the paper's Figure 2, 2.17") {
    CHECK(std::sqrt(128 * star_discrepancy(base_points("halton", 128))) == Approx(2.17).margin(0.005));
}

TEST_CASE("star discrepancy: none and too many points are refused in one line") {
    CHECK_THROWS_AS(star_discrepancy({}), UsageError);
    const std::vector<FixedPoint2> many(max_star_discrepancy_points + 1);
    CHECK_THROWS_WITH(star_discrepancy(many), Catch::Contains("65537") && !Catch::Contains("\n"));
}
