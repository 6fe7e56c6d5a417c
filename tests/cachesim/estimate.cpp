#include "cachesim/analysis/estimate.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace raycache::cachesim;

TEST_CASE("Student's t quantiles are those of the tables") {
    CHECK(student_t_975(1) == Approx(12.7062).epsilon(1e-5));
    CHECK(student_t_975(2) == Approx(4.30265).epsilon(1e-5));
    CHECK(student_t_975(9) == Approx(2.26216).epsilon(1e-5));
    CHECK(student_t_975(30) == Approx(2.04227).epsilon(1e-5));
}

TEST_CASE("a ratio estimate is as computed by hand") {
    // R = 15/6 = 2.5; residuals -0.5, 1, -0.5; var = 1.5 / (3 * 2 * 2^2) = 1/16; t(2) / 4.
    const Estimate e = ratio_of_totals({{2, 6, 7}, {1, 2, 3}});
    CHECK(e.mean == 2.5);
    REQUIRE(e.half_width);
    CHECK(*e.half_width == Approx(0.95 * std::sqrt(2 / (1 - 0.95 * 0.95)) / 4).epsilon(1e-12));
}

TEST_CASE("a paired ratio estimate is as computed by hand") {
    // Own R = 6/4 with residuals -0.5, 0.5 and mean y 3; baseline R' = 8/4, residuals 0, 0. Q = 0.75.
    // e = -1/6, 1/6; var = Q^2 (2/36) / 2 = (0.75/6)^2.
    const Estimate e = ratio_to_baseline({{2.5, 3.5}, {2, 2}}, {{4, 4}, {2, 2}});
    CHECK(e.mean == 0.75);
    REQUIRE(e.half_width);
    CHECK(*e.half_width == Approx(student_t_975(1) * 0.125).epsilon(1e-12));
}

TEST_CASE("what all strategies share cancels in a paired ratio") {
    const Estimate e = ratio_to_baseline({{1, 20, 3}, {1, 2, 3}}, {{2, 40, 6}, {1, 2, 3}});
    CHECK(e.mean == Approx(0.5));
    CHECK(*e.half_width == Approx(0).margin(1e-12));
}

TEST_CASE("estimates without a value are no numbers and have no interval") {
    CHECK(std::isnan(ratio_of_totals({{1, 2}, {0, 0}}).mean));
    CHECK_FALSE(ratio_of_totals({{1, 2}, {0, 0}}).half_width);
    CHECK(ratio_of_totals({{3}, {2}}).mean == 1.5);
    CHECK_FALSE(ratio_of_totals({{3}, {2}}).half_width);
    CHECK(std::isnan(ratio_to_baseline({{1, 2}, {1, 1}}, {{0, 0}, {1, 1}}).mean));
    CHECK(ratio_to_baseline({{0, 0}, {1, 1}}, {{1, 2}, {1, 1}}).mean == 0);
    CHECK(std::isnan(ratio_of_totals({{}, {}}).mean));
}

TEST_CASE("rates of exactly 0 and 1, and values that do not vary, have an interval of nothing") {
    for (const double rate : {0.0, 1.0, 0.25}) {
        const Estimate e = ratio_of_totals({{rate * 4, rate * 8, rate * 40}, {4, 8, 40}});
        CHECK(e.mean == rate);
        CHECK(e.half_width == 0);
    }
    // A factor that is 0: a product of 0, of which a relative error says nothing.
    const Estimate zero = product_of_powers({{{0, 0}, 1}, {{3, 4}, -1}});
    CHECK(zero.mean == 0);
    CHECK_FALSE(zero.half_width);
    CHECK(std::isnan(product_of_powers({{{3, 4}, 1}, {{0, 0}, -1}}).mean));
}

TEST_CASE("two units have the interval of one degree of freedom, and shares of sums beyond 2^53 keep it") {
    // R = 3/2; residuals -0.5, 0.5; half width t(1) sqrt(0.5 / (2 * 1 * 1)).
    CHECK(*ratio_of_totals({{1, 2}, {1, 1}}).half_width == Approx(student_t_975(1) * 0.5).epsilon(1e-12));
    const double many = std::ldexp(1.0, 60);
    const Estimate e = ratio_of_totals({{many, 2 * many}, {many, many}});
    CHECK(e.mean == 1.5);
    CHECK(*e.half_width == Approx(student_t_975(1) * 0.5).epsilon(1e-12));
}
