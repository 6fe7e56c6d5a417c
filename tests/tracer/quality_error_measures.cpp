// Errors of pictures made by hand.
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/tracer/error_pictures.hpp"

namespace raycache::tracer {

using namespace test;

TEST_CASE("a picture equal to its reference has no error, and no structure to speak of", "[quality]") {
    const ErrorMeasures m = measure(plain(32, 32, 1), ones(32, 32));
    CHECK(m.rmse.value == 0);
    CHECK(std::isnan(m.r8.value));
    CHECK(m.mean_error.value == 0);
    CHECK(m.reference_rmse == 0);
    CHECK(m.reference_luminance == Approx(1));
}

TEST_CASE("an error that all pixels share has R8 64, its own size as RMSE and mean, and the largest z", "[quality]") {
    const ErrorMeasures m = measure(plain(32, 32, 1.5F), ones(32, 32));
    CHECK(m.rmse.value == Approx(0.5));
    CHECK(m.rmse.half_width == Approx(0).margin(1e-12));
    CHECK(m.relative_rmse.value == Approx(0.5 / std::sqrt(1.0001)));
    CHECK(m.r8.value == Approx(64));
    CHECK(m.block_rmse.value == Approx(0.5));
    CHECK(m.mean_error.value == Approx(0.5));
    CHECK(m.z_pixels == Approx(8));  // root of a tile's 64 pixels
    CHECK(m.structured_mse == Approx(0.25));
    CHECK_FALSE(m.z_seeds);
}

TEST_CASE("errors that cancel within every block have R8 0", "[quality]") {
    const Image image = picture(16, 16, [](auto x, auto y) {
        const float v = (x + y) % 2 ? 1.25F : 0.75F;
        return Vec3{v, v, v};
    });
    const ErrorMeasures m = measure(image, ones(16, 16));
    CHECK(m.rmse.value == Approx(0.25));
    CHECK(m.r8.value == Approx(0).margin(1e-12));
    CHECK(m.mean_error.value == Approx(0).margin(1e-12));
}

TEST_CASE("one pixel wrong in one channel: every figure by hand", "[quality]") {
    Image image = plain(16, 8, 1);
    image.pixels[9].x += 3;  // second block
    const ErrorMeasures m = measure(image, ones(16, 8));
    CHECK(m.rmse.value == Approx(std::sqrt(9.0 / 3 / 128)));
    CHECK(m.block_rmse.value == Approx(std::sqrt(9.0 / 3 / (64 * 64) / 2)));
    CHECK(m.r8.value == Approx(1));
    CHECK(m.mean_error.value == Approx(0.2126 * 3 / 128));
    REQUIRE(m.sums.blocks.columns == 2);
    REQUIRE(m.sums.blocks.rows == 1);
    CHECK(m.sums.blocks.mean[0] == 0);
    CHECK(m.sums.blocks.mean[1] == Approx(0.2126 * 3 / 64));
    const auto worst = worst_block(m);
    REQUIRE(worst);
    CHECK(worst->x == 8);
    CHECK(worst->y == 0);
    CHECK(worst->mean_error == Approx(0.2126 * 3 / 64));
}

TEST_CASE("white noise has R8 near 1, z near 1 and the RMSE it was made with, within the errors stated", "[quality]") {
    Random random(1);
    const ErrorMeasures m = measure(noisy(512, 512, random, 1, 0.1F), ones(512, 512));
    CHECK(m.rmse.value == Approx(0.1).epsilon(0.01));
    CHECK(std::fabs(m.rmse.value - 0.1) < 4 * m.rmse.half_width);
    CHECK(std::fabs(m.r8.value - 1) < 4 * m.r8.half_width);
    CHECK(m.r8.half_width < 0.1);
    CHECK(m.z_pixels < 1.4);
    CHECK(m.z_pixels > 0.5);
    CHECK(m.mean_error.half_width == Approx(2.13 * 0.1 / 512).epsilon(0.5));  // from 16 tiles
}

TEST_CASE("noise of 8 x 8 patches has R8 64; half patches and half white noise lie half way", "[quality]") {
    Random random(2);
    std::vector<float> patches;
    for (int i = 0; i < 64 * 64; ++i) patches.push_back(random.between(-0.1F, 0.1F));
    const auto patch = [&](std::uint32_t x, std::uint32_t y) { return patches[y / 8 * 64 + x / 8]; };
    const Image structured = picture(512, 512, [&](auto x, auto y) {
        const float v = 1 + patch(x, y);
        return Vec3{v, v, v};
    });
    CHECK(measure(structured, ones(512, 512)).r8.value == Approx(64));
    const Image mixed = picture(512, 512, [&](auto x, auto y) {
        const float v = 1 + patch(x, y) + random.between(-0.1F, 0.1F);
        return Vec3{v, v, v};
    });
    CHECK(measure(mixed, ones(512, 512)).r8.value == Approx(32.5).epsilon(0.05));
}

TEST_CASE("the reference's own noise is taken off", "[quality]") {
    Random random(3);
    const Image a = noisy(256, 256, random, 1, 0.2F), b = noisy(256, 256, random, 1, 0.2F);
    const Reference reference = reference_of(a, b);
    const ErrorMeasures m = measure(noisy(256, 256, random, 1, 0.2F), reference);
    CHECK(m.reference_rmse == Approx(0.2 / std::sqrt(2)).epsilon(0.01));
    CHECK(m.rmse.value == Approx(0.2).epsilon(0.02));
    CHECK(m.r8.value == Approx(1).epsilon(0.2));
    CHECK(m.z_pixels < 1.4);
    // The truth itself: its error is 0, which is below the reference's noise.
    const ErrorMeasures truth = measure(plain(256, 256, 1), reference);
    CHECK_FALSE(truth.rmse.resolved());
    REQUIRE(truth.rmse.below);
    CHECK(*truth.rmse.below < 0.03);
    CHECK(*truth.rmse.below > 0.01);
    CHECK(std::isnan(truth.r8.value));
    CHECK_FALSE(truth.r8.below);
}

TEST_CASE("shared errors that change with the seed are no bias; those that stay are", "[quality]") {
    Random random(4);
    std::vector<Image> changing, staying;
    for (int seed = 0; seed < 16; ++seed) {
        const float shared = random.between(-0.1F, 0.1F);
        changing.push_back(noisy(64, 64, random, 1 + shared, 0.01F));
        staying.push_back(noisy(64, 64, random, 1.05F, 0.01F));
    }
    const ErrorMeasures c = measure_errors(changing, ones(64, 64)), s = measure_errors(staying, ones(64, 64));
    REQUIRE(c.z_seeds);
    REQUIRE(s.z_seeds);
    // All tiles move together, so this is one Student's t of 15 degrees of freedom, not a mean of 16.
    CHECK(*c.z_seeds < 3);
    CHECK(*s.z_seeds > 10);
    CHECK(s.mean_error.value == Approx(0.05).epsilon(0.02));
    CHECK(s.mean_error.half_width < 0.001);
    CHECK(c.mean_error.half_width > 0.02);
    CHECK(c.r8.value > 50);
}

TEST_CASE("pixels outside whole blocks count for the RMSE only; a picture smaller than a block has no R8",
          "[quality]") {
    Image image = plain(12, 9, 1);
    image.pixels[10] = {2, 2, 2};
    const ErrorMeasures m = measure(image, ones(12, 9));
    CHECK(m.rmse.value == Approx(std::sqrt(1.0 / 108)));
    CHECK(std::isnan(m.r8.value));  // no error within the one whole block
    CHECK(m.sums.blocks.columns * m.sums.blocks.rows == 1);
    const ErrorMeasures tiny = measure(plain(3, 2, 2), ones(3, 2));
    CHECK(tiny.rmse.value == Approx(1));
    CHECK(std::isnan(tiny.r8.value));
    CHECK_FALSE(worst_block(tiny));
}

TEST_CASE("a black reference gives no division by zero", "[quality]") {
    const Reference black{plain(16, 16, 0), plain(16, 16, 0), "test"};
    const ErrorMeasures m = measure(plain(16, 16, 1), black);
    CHECK(m.rmse.value == Approx(1));
    CHECK(m.relative_rmse.value == 0);
}

}  // namespace raycache::tracer
