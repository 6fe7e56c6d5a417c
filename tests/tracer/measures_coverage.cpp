#include "tracer/sampling/measures/coverage.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <numeric>
#include <random>

#include "tracer/sampling/sampling_strategy.hpp"
#include "traces/error.hpp"

using namespace raycache;
using namespace raycache::tracer;

namespace {

FixedPoint2 at(double x, double y) {
    return {static_cast<std::uint32_t>(x * 0x1p32), static_cast<std::uint32_t>(y * 0x1p32)};
}

std::vector<FixedPoint2> grid(unsigned m) {
    std::vector<FixedPoint2> points;
    for (unsigned y = 0; y < m; ++y)
        for (unsigned x = 0; x < m; ++x) points.push_back(at(double(x) / m, double(y) / m));
    return points;
}

/// Points on a 32x32 lattice: the middle of the largest empty square lies on the lattice of half its spacing.
double naive_hole(const std::vector<FixedPoint2>& points) {
    constexpr unsigned places = 64;
    double widest = 0;
    for (unsigned y = 0; y < places; ++y) {
        for (unsigned x = 0; x < places; ++x) {
            double nearest = 1;
            for (const FixedPoint2& p : points) {
                const auto apart = [](double a, double b) { return std::min(std::abs(a - b), 1 - std::abs(a - b)); };
                nearest = std::min(nearest, std::max(apart(double(x) / places, p.x * 0x1p-32),
                                                     apart(double(y) / places, p.y * 0x1p-32)));
            }
            widest = std::max(widest, nearest);
        }
    }
    return 2 * widest;
}

std::vector<FixedPoint2> base_points(const char* sequence, std::uint64_t n, std::uint32_t d = 0) {
    StrategySettings s;
    s.sequence = sequence;
    s.decorrelation = "coherent";
    s.parameters.spp = n;
    const SamplingStrategy strategy(s, d + 2);
    std::vector<FixedPoint2> points;
    for (std::uint64_t i = 0; i < n; ++i) {
        const auto point = strategy.base_point(i);
        points.push_back({point[d], point[d + 1]});
    }
    return points;
}

}  // namespace

TEST_CASE("the largest empty square of a lattice is its cell, and of one point the whole square") {
    for (const unsigned m : {1u, 2u, 4u, 8u, 32u}) CHECK(largest_empty_square(grid(m)) == Approx(1.0 / m).margin(1e-9));
    CHECK(largest_empty_square(std::vector{at(0.3, 0.9)}) == Approx(1).margin(1e-9));
    CHECK(largest_empty_square(std::vector{at(0, 0), at(0.5, 0.5)}) == Approx(1).margin(1e-9));
    CHECK(largest_empty_square(std::vector{at(0, 0), at(0.5, 0.5), at(0.5, 0), at(0, 0.5)}) ==
          Approx(0.5).margin(1e-9));
}

TEST_CASE("the largest empty square is that of a search over all places") {
    std::mt19937 random(7);
    for (unsigned trial = 0; trial < 60; ++trial) {
        std::vector<FixedPoint2> points;
        for (unsigned i = 0; i < 1 + trial % 20; ++i) points.push_back(at(random() % 32 / 32.0, random() % 32 / 32.0));
        CAPTURE(trial, points.size());
        CHECK(largest_empty_square(points) == Approx(naive_hole(points)).margin(1e-9));
    }
}

TEST_CASE("the largest gap goes round the end") {
    const std::vector<std::uint32_t> points{at(0.75, 0).x, at(0.125, 0).x, at(0.25, 0).x};
    CHECK(largest_gap(points) == 0.5);
    CHECK(largest_gap(std::vector<std::uint32_t>{5}) == 1);
    CHECK(largest_gap(std::vector{at(0.75, 0).x, at(0.5, 0).x}) == 0.75);
}

TEST_CASE("windows of the lattice's spacing cover the square once, of twice that four times") {
    for (const unsigned m : {2u, 4u, 8u}) {
        const Coverage once = coverage(grid(m), 1.0 / m), four = coverage(grid(m), 2.0 / m);
        REQUIRE(once.share.size() == 2);
        CHECK(once.share[1] == Approx(1));
        CHECK(once.uneven(m * m, 1.0 / m) == Approx(0).margin(1e-12));
        REQUIRE(four.share.size() == 5);
        CHECK(four.share[4] == Approx(1));
        CHECK(four.density(4, m * m, 2.0 / m) == Approx(1));
    }
    const Coverage half = coverage(std::vector{at(0.9, 0.1)}, 0.5);
    CHECK(half.holes() == Approx(0.75));
    CHECK(half.share[1] == Approx(0.25));
    CHECK(half.least(1, 0.5) == 0);
    CHECK(half.most(1, 0.5) == Approx(4));
    CHECK(coverage(std::vector{at(0.9, 0.1), at(0, 0)}, 1).share[2] == Approx(1));
}

TEST_CASE("the mean density is one, and there are holes exactly below the largest empty square") {
    for (const char* sequence : {"sobol", "halton"}) {
        for (const std::uint64_t n : {5u, 64u, 200u}) {
            const auto points = base_points(sequence, n);
            const double hole = largest_empty_square(points);
            for (const double mu : {0.5 * hole, 0.999 * hole, hole, std::min(1.0, 1.5 * hole)}) {
                const Coverage c = coverage(points, mu);
                double whole = 0, mean = 0;
                for (std::size_t k = 0; k < c.share.size(); ++k) {
                    whole += c.share[k];
                    mean += c.share[k] * c.density(k, n, mu);
                }
                CAPTURE(sequence, n, mu, hole);
                CHECK(whole == Approx(1));
                CHECK(mean == Approx(1).epsilon(1e-6));
                CHECK((c.holes() > 0) == (mu < hole));
            }
        }
    }
}

TEST_CASE("at the paper's Figure 2 the discrepancy asks for K = 2.17 and holes close at 1.955") {
    const auto points = base_points("halton", 128);
    CHECK(std::sqrt(128 * star_discrepancy(points)) == Approx(2.166).margin(0.001));
    CHECK(hole_free_k(largest_empty_square(points), 128, 2) == Approx(1.955).margin(0.001));
    CHECK(hole_free_k(largest_empty_square(base_points("halton", 1024, 30)), 1024, 2) == Approx(12.96).margin(0.01));
}

TEST_CASE("coverage of no points, too many, or an impossible window is refused") {
    const std::vector<FixedPoint2> none, many(max_coverage_points + 1);
    CHECK_THROWS_AS(largest_empty_square(none), UsageError);
    CHECK_THROWS_AS(largest_gap({}), UsageError);
    CHECK_THROWS_AS(coverage(none, 0.5), UsageError);
    CHECK_THROWS_AS(coverage(many, 0.5), UsageError);
    for (const double mu : {0.0, -0.1, 1.1}) CHECK_THROWS_AS(coverage(grid(2), mu), UsageError);
}
