// Factors of the traffic identity: their intervals, and which of them is named as the cause.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "cachesim/analysis/estimate.hpp"
#include "cachesim/analysis/traffic_identity.hpp"
#include "tests/cachesim/series.hpp"

using namespace raycache::cachesim;
using raycache::cachesim::test::counters;

namespace {

/// Miss rates of L1 and the levels below.
Factors with_means(double work, double simt, double coalescing, const std::vector<double>& miss_rates) {
    Factors f;
    for (const double mean : {work, simt, coalescing}) f.terms.push_back({mean, {}});
    f.equal_miss_rates.mean = work * simt * coalescing;
    double together = 1;
    for (const double rate : miss_rates) {
        f.terms.push_back({rate, {}});
        f.locality.push_back({together *= rate, {}});
    }
    return f;
}

}  // namespace

TEST_CASE("the cause of fewer DRAM bytes is never a miss rate that another one outweighs") {
    // L1 misses less, L2 so much more that both together raise the traffic; fuller warps lower it after all.
    const Factors f = with_means(1.0, 0.75, 0.95, {0.611, 2.044});
    REQUIRE(f.product() < 1);
    CHECK(main_cause(f, 1)->name == "SIMT efficiency");
    CHECK(main_cause(f, 0)->name == "L1 locality");
    CHECK(main_cause(with_means(1, 0.95, 1, {0.6, 0.8}), 1)->name == "cache locality");
    CHECK_FALSE(main_cause(with_means(1, 1, 1, {1, 1}), 1));
}

TEST_CASE("the named cause points where the change points, and is the largest factor that does") {
    std::mt19937_64 random(5);
    std::lognormal_distribution<double> any(0, 0.4);
    for (int round = 0; round < 2000; ++round) {
        const Factors f = with_means(any(random), any(random), any(random), {any(random), any(random), any(random)});
        const double before = std::log(f.equal_miss_rates.mean);
        for (std::size_t level = 0; level < 3; ++level) {
            const double locality = f.locality[level].mean;
            const double whole = before + std::log(locality);
            const auto cause = main_cause(f, level);
            REQUIRE(cause);
            const double named = std::log(cause->factor.mean);
            REQUIRE((named < 0) == (whole < 0));
            for (const double other : {f.terms[0].mean, f.terms[1].mean, f.terms[2].mean, locality})
                if ((std::log(other) < 0) == (whole < 0)) REQUIRE(std::fabs(std::log(other)) <= std::fabs(named));
        }
    }
}

TEST_CASE("joined factors are the products of the single ones") {
    const std::vector<Counters> base{counters(100, 4000, 800, 8000, 4000, 1000),
                                     counters(90, 4100, 850, 8500, 4300, 900)};
    const std::vector<Counters> other{counters(100, 3900, 600, 6500, 2500, 800),
                                      counters(95, 4000, 640, 6900, 2600, 700)};
    const auto f = traffic_factors(base, other, CacheUnits{});
    REQUIRE(f);
    CHECK(f->equal_miss_rates.mean == Approx(f->terms[0].mean * f->terms[1].mean * f->terms[2].mean).epsilon(1e-12));
    CHECK(f->cache_locality().mean == Approx(f->terms[3].mean * f->terms[4].mean).epsilon(1e-12));
    for (const Estimate& e : {f->terms[0], f->terms[4], f->equal_miss_rates, f->cache_locality()}) CHECK(e.half_width);
    CHECK_FALSE(traffic_factors({base[0]}, {other[0]}, CacheUnits{})->terms[0].half_width);
}

TEST_CASE("a product of powers of two ratios is the paired ratio, interval and all") {
    const Sums own{{2.5, 3.5, 3}, {2, 2, 2.2}}, base{{4, 4.4, 5}, {2, 2.1, 2}};
    const Estimate paired = ratio_to_baseline(own, base);
    const Estimate product = product_of_powers({{own.y, 1}, {own.x, -1}, {base.y, -1}, {base.x, 1}});
    CHECK(product.mean == Approx(paired.mean).epsilon(1e-12));
    CHECK(*product.half_width == Approx(*paired.half_width).epsilon(1e-12));
    CHECK(std::isnan(product_of_powers({{{1, 2}, 1}, {{0, 0}, -1}}).mean));
    CHECK_FALSE(product_of_powers({{{1}, 1}, {{2}, -1}}).half_width);
}

TEST_CASE("the 95 % intervals of factors and of parts of a speed-up hold the true value in about 95 of 100 cases") {
    // Eight sample indices; each scatters by a tenth, in part alike for both strategies, as real ones do.
    std::mt19937_64 random(11);
    std::normal_distribution<double> normal;
    constexpr int rounds = 4000, indices = 8;
    int factor_holds = 0, part_holds = 0;
    for (int round = 0; round < rounds; ++round) {
        Sums own, base;
        std::vector<double> real_base, real_other, ideal_base, ideal_other;
        for (int i = 0; i < indices; ++i) {
            const double shared = 1 + 0.1 * normal(random);
            const auto scatter = [&](double mean) { return mean * shared * (1 + 0.05 * normal(random)); };
            own.x.push_back(scatter(100));
            own.y.push_back(scatter(60));
            base.x.push_back(scatter(110));
            base.y.push_back(scatter(88));
            real_base.push_back(scatter(1500));
            real_other.push_back(scatter(1000));
            ideal_base.push_back(scatter(900));
            ideal_other.push_back(scatter(750));
        }
        const auto holds = [](const Estimate& e, double truth) { return std::fabs(e.mean - truth) <= *e.half_width; };
        factor_holds += holds(ratio_to_baseline(own, base), (60.0 / 100) / (88.0 / 110));
        part_holds += holds(product_of_powers({{real_base, 1}, {real_other, -1}, {ideal_base, -1}, {ideal_other, 1}}),
                            (1500.0 / 1000) / (900.0 / 750));
    }
    CHECK(factor_holds / static_cast<double>(rounds) == Approx(0.95).margin(0.015));
    CHECK(part_holds / static_cast<double>(rounds) == Approx(0.95).margin(0.015));
}
