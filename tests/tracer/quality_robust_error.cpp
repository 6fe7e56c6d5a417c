// Fireflies: what they do to errors, and how they are found.
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/tracer/error_pictures.hpp"

namespace raycache::tracer {

using namespace test;

namespace {

constexpr std::uint32_t side = 64;

Image with_fireflies(Image image, std::initializer_list<std::size_t> pixels, float value) {
    for (const std::size_t p : pixels) image.pixels[p] = {value, value, value};
    return image;
}

}  // namespace

TEST_CASE("the median of means is the RMSE of plain noise, and a dozen fireflies leave it where it is", "[quality]") {
    Random random(21);
    const Image noise = noisy(side, side, random, 1, 0.1F);
    const ErrorMeasures before = measure(noise, ones(side, side));
    CHECK(before.robust_rmse.value == Approx(0.1).epsilon(0.05));
    CHECK(std::fabs(before.robust_rmse.value - 0.1) < before.robust_rmse.half_width * 2);
    const Image bright = with_fireflies(noise, {1, 70, 500, 777, 900, 1500, 2000, 2222, 2900, 3000, 3500, 4000}, 500);
    const ErrorMeasures after = measure(bright, ones(side, side));
    CHECK(after.rmse.value > 20);
    CHECK(after.robust_rmse.value == Approx(0.1).epsilon(0.1));
}

TEST_CASE("the interval of the median of means holds the error of noise in 95 of 100 pictures", "[quality]") {
    Random random(22);
    int held = 0;
    for (int trial = 0; trial < 200; ++trial) {
        const ErrorMeasures m = measure(noisy(side, side, random, 1, 0.1F), ones(side, side));
        held += std::fabs(m.robust_rmse.value - 0.1) <= m.robust_rmse.half_width;
    }
    CHECK(held >= 184);
}

TEST_CASE("a pixel that holds half of the squared error is found, plain noise has none", "[quality]") {
    Random random(23);
    const Image noise = noisy(side, side, random, 1, 0.1F);
    CHECK_FALSE(measure(noise, ones(side, side)).few_pixels);
    const auto one = measure(with_fireflies(noise, {777}, 20), ones(side, side)).few_pixels;
    REQUIRE(one);
    CHECK(one->count == 1);
    CHECK(one->largest == 777);
    CHECK(one->share > 0.8);
    const auto three = measure(with_fireflies(noise, {5, 777, 3000}, 5), ones(side, side)).few_pixels;
    REQUIRE(three);
    CHECK(three->count == 3);
    CHECK_FALSE(measure(with_fireflies(noise, {5, 6, 7, 8, 9, 10, 11}, 5), ones(side, side)).few_pixels);
}

TEST_CASE("a ranking that a firefly decides is refused, whichever of the two has it; robust errors still rank",
          "[quality]") {
    Random random(24);
    const Reference truth = ones(side, side);
    const ErrorMeasures good = measure(noisy(side, side, random, 1, 0.1F), truth);
    const Image worse = noisy(side, side, random, 1, 0.13F);
    const ErrorMeasures bad = measure(worse, truth);
    const ErrorMeasures bright = measure(with_fireflies(noisy(side, side, random, 1, 0.1F), {777}, 30), truth);
    const RmseRatio fair = rmse_ratio(bad, good);
    CHECK_FALSE(fair.decided_by_pixels);
    CHECK(fair.value.value == Approx(1.3).epsilon(0.05));
    for (const RmseRatio& refused : {rmse_ratio(bright, bad), rmse_ratio(bad, bright)}) {
        CHECK(refused.decided_by_pixels == std::size_t{1});
        CHECK_FALSE(refused.value.resolved());
        CHECK(refused.robust.resolved());
    }
    CHECK(rmse_ratio(bright, bad).robust.value < 1);
    CHECK(rmse_ratio(bad, bright).robust.value > 1);
}

TEST_CASE("a ranking whose sign hangs on three pixels is refused although none of them holds half", "[quality]") {
    const Reference truth = ones(side, side);
    // Exactly equal errors but for three pixels: any seed says the same, so the interval is narrow.
    const Image even = plain(side, side, 1.1F), uneven = with_fireflies(plain(side, side, 1.1F), {5, 777, 3000}, 2);
    const std::vector<Image> a{uneven, uneven}, b{even, even};
    const RmseRatio ratio = rmse_ratio(measure_errors(a, truth), measure_errors(b, truth));
    CHECK(few_pixels_between(measure_errors(a, truth).sums, measure_errors(b, truth).sums) == std::size_t{3});
    CHECK(ratio.decided_by_pixels == std::size_t{3});
}

TEST_CASE("a handful is one pixel in 10 000, at least three of pictures worth the name", "[quality]") {
    CHECK(handful(100) == 1);
    CHECK(handful(1024) == 3);
    CHECK(handful(512 * 512) == 27);
}

}  // namespace raycache::tracer
