#include "tracer/sampling/measures/error_statistics.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

using namespace raycache::tracer;

namespace {

SamplingStrategy strategy(const char* decorrelation, std::uint64_t n, double k = 2.5, unsigned s = 2) {
    StrategySettings settings;
    settings.decorrelation = decorrelation;
    settings.parameters.spp = n;
    settings.parameters.seed = 1;
    settings.parameters.k = k;
    settings.parameters.s = s;
    return {settings, test_dimensions};
}

/// z of the bias test: root mean square over the integrands.
double bias(const SamplingStrategy& samples) {
    double sum = 0;
    for (const TestIntegrand& f : test_integrands())
        sum += std::pow(error_statistics(errors_of(samples, f), test_picture_side).z(), 2);
    return std::sqrt(sum / static_cast<double>(test_integrands().size()));
}

double structure(const SamplingStrategy& samples) {
    double sum = 0, count = 0;
    for (const TestIntegrand& f : test_integrands()) {
        if (!f.edges || f.dimensions != 4) continue;
        sum += error_statistics(errors_of(samples, f), test_picture_side).r8;
        count += 1;
    }
    return sum / count;
}

}  // namespace

TEST_CASE("volumes of half-spaces are those of simplices and their complements") {
    CHECK(half_space_volume({2}, 0.6) == Approx(0.3));
    CHECK(half_space_volume({1, 1}, 1) == Approx(0.5));
    CHECK(half_space_volume({1, 1, 1}, 1) == Approx(1.0 / 6));
    CHECK(half_space_volume({1, 1, 1, 1}, 1) == Approx(1.0 / 24));
    CHECK(half_space_volume({1, 1, 1, 1}, 2) == Approx(0.5));
    CHECK(half_space_volume({1, -1}, 0) == Approx(0.5));
    CHECK(half_space_volume({1, -1}, -0.5) == Approx(0.125));
    CHECK(half_space_volume({1, 2}, 5) == Approx(1));
    CHECK(half_space_volume({1, 2}, -1) == 0);
}

TEST_CASE("the mean of every test integrand is what many samples give") {
    const SamplingStrategy samples = strategy("coherent", 65536);
    std::vector<std::vector<std::uint32_t>> points;
    for (std::uint64_t i = 0; i < 65536; ++i) points.push_back(samples.base_point(i));
    for (const TestIntegrand& f : test_integrands()) {
        for (const double place : {0.0, 0.7}) {
            double sum = 0;
            for (const auto& p : points) {
                std::array<double, test_dimensions> u{};
                for (unsigned d = 0; d < test_dimensions; ++d) u[d] = p[d] * 0x1p-32;
                sum += f.value(u, place, 1 - place);
            }
            INFO(f.name << " at " << place);
            CHECK(sum / 65536 == Approx(f.mean(place, 1 - place)).margin(1.5e-3));
        }
    }
}

TEST_CASE("R8 is 1 for independent errors, 64 where blocks err alike, and blocks of zero mean have none") {
    constexpr std::uint32_t side = 64;
    std::mt19937 random(3);
    std::normal_distribution<double> normal;
    std::vector<double> white(side * side), blocks(white.size()), alternating(white.size());
    std::vector<double> of_block(64);
    for (double& b : of_block) b = normal(random);
    for (std::uint32_t i = 0; i < white.size(); ++i) {
        white[i] = normal(random);
        blocks[i] = of_block[i / side / 8 * 8 + i % side / 8];
        alternating[i] = (i % side + i / side) % 2 == 0 ? 1 : -1;
    }
    CHECK(error_statistics(white, side).r8 == Approx(1).margin(0.5));
    CHECK(std::abs(error_statistics(white, side).z()) < 3);
    CHECK(error_statistics(blocks, side).r8 == Approx(64));
    CHECK(error_statistics(alternating, side).r8 == Approx(0).margin(1e-12));
    CHECK(error_statistics(alternating, side).mse == Approx(1));
}

TEST_CASE("error statistics of four numbers are those worked out by hand") {
    std::vector<double> errors(64, 0.0);
    errors[0] = 8;
    const ErrorStatistics s = error_statistics(errors, 8);
    CHECK(s.mean == Approx(0.125));
    CHECK(s.mse == Approx(1));
    CHECK(s.r8 == Approx(1));  // one block: 64 * (1/8)^2 / 1
    CHECK(s.standard_error == Approx(std::sqrt((64 - 64 * 0.125 * 0.125) / 63 / 64)));
    CHECK(s.common() == Approx(1.0 / 64));
    const std::vector<double> none(64, 0.0);
    CHECK(error_statistics(none, 8).r8 == 1);
    CHECK(error_statistics(none, 8).z() == 0);
}

TEST_CASE("cranley-patterson and random are unbiased, micro-jitter is not and errs in common with its neighbours") {
    for (const std::uint64_t n : {16u, 64u}) {
        CAPTURE(n);
        CHECK(bias(strategy("cranley-patterson", n)) <= 1.4);
        CHECK(bias(strategy("random", n)) <= 1.4);
        const double narrow = bias(strategy("micro-jitter", n, 1)), wide = bias(strategy("micro-jitter", n, 2));
        CHECK(narrow > 5);
        CHECK(wide < narrow);
        CHECK(structure(strategy("micro-jitter", n, 1)) > 5);
        CHECK(structure(strategy("cranley-patterson", n)) < 1.5);
        CHECK(structure(strategy("coherent", n)) > 50);
        // All four dimensions jointly: less of the error is common.
        CHECK(structure(strategy("micro-jitter", n, 1, 4)) < structure(strategy("micro-jitter", n, 1, 2)));
    }
}
