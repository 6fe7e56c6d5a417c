// Gains at equal error, and who has none.
#include "tools/jobs/equal_error.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

using namespace raycache;
using namespace raycache::tools;

namespace {

tracer::RmseRatio ratio(double value, double half_width) { return {{value, half_width}, {value, 0}, {}, false}; }

tracer::ErrorMeasures errors(double r8, double half_width, double z) {
    tracer::ErrorMeasures e{};
    e.r8 = {r8, half_width};
    e.z_pixels = z;
    return e;
}

}  // namespace

TEST_CASE("the gain at equal error is the speed-up times the variance ratio: the ratio of times to one error") {
    // 2 s and an RMSE of 0.3 at N samples against 3 s and 0.2: the error 0.1 takes 2 * 9 s and 3 * 4 s.
    const auto gain = gain_at_equal_error({2.0 / 3, 0.0}, ratio(0.2 / 0.3, 0));
    CHECK(gain.mean == Approx(18.0 / 12));
    CHECK(*gain.half_width == 0);
    CHECK_FALSE(gain_at_equal_error({1.2, std::nullopt}, ratio(1, 0.1)).half_width);
    CHECK(std::isnan(gain_at_equal_error({1.2, 0.1}, ratio(std::nan(""), std::nan(""))).mean));
    tracer::RmseRatio of_few = ratio(1, 0.1);
    of_few.decided_by_pixels = 2;
    CHECK(std::isnan(gain_at_equal_error({1.2, 0.1}, of_few).mean));
}

TEST_CASE("the interval of a gain holds the true gain in 95 % of drawn speed-ups and error ratios") {
    constexpr double speed_up = 1.2, rmse = 0.9, of_speed_up = 0.03, of_rmse = 0.02;  // true values, standard errors
    std::mt19937_64 random(7);
    std::normal_distribution<double> a(speed_up, of_speed_up), b(rmse, of_rmse);
    int held = 0;
    constexpr int drawn = 4000;
    for (int i = 0; i < drawn; ++i) {
        const auto gain = gain_at_equal_error({a(random), 1.96 * of_speed_up}, ratio(b(random), 1.96 * of_rmse));
        held += std::fabs(gain.mean - speed_up / (rmse * rmse)) <= *gain.half_width;
    }
    CHECK(held > 0.94 * drawn);
    CHECK(held < 0.96 * drawn);
}

TEST_CASE("a strategy whose pixels share error for certain, or with a bias, has no time to an equal error") {
    using Catch::Matchers::Contains;
    CHECK(no_equal_error(errors(1.2, 0.3, 1.0), false).empty());
    CHECK(no_equal_error(errors(2.2, 0.3, 1.0), false).empty());  // perhaps
    CHECK_THAT(no_equal_error(errors(2.4, 0.3, 1.0), false), Contains("R8 2.40 ±0.30, at most 2"));
    CHECK_THAT(no_equal_error(errors(1.2, 0.3, 1.5), false), Contains("bias: z 1.5, at most 1.4"));
    CHECK(no_equal_error(errors(1.2, 0.3, 1.5), true).empty());  // the test's own noise
    tracer::ErrorMeasures seeds = errors(1.2, 0.3, 1.0);
    seeds.z_seeds = 9.9;
    CHECK_THAT(no_equal_error(seeds, false), Contains("bias: z seeds 9.9"));
    CHECK(no_equal_error(errors(std::nan(""), std::nan(""), std::nan("")), false).empty());
}
