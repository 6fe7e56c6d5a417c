// The hash behind every random offset: known values, uniformity, independence, and the Wang-hash trap.
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>

#include "tracer/sampling/hash.hpp"

using namespace raycache::tracer;

namespace {

constexpr std::uint32_t samples = 65536;

// Chi-square statistic for 256 equally likely cells, 255 degrees of freedom: mean 255, standard deviation 22.6.
double chi_square(const std::function<std::uint32_t(std::uint32_t)>& cell) {
    std::array<std::uint32_t, 256> count{};
    for (std::uint32_t n = 0; n < samples; ++n) ++count.at(cell(n));
    constexpr double expected = samples / 256.0;
    double sum = 0;
    for (const std::uint32_t c : count) sum += (c - expected) * (c - expected) / expected;
    return sum;
}
constexpr double six_sigma = 255 + 6 * 22.6;

/// Cell of a 16x16 grid.
std::uint32_t cell(std::uint32_t a, std::uint32_t b) { return (a >> 28) * 16 + (b >> 28); }

std::uint32_t wang(std::uint32_t key) {
    key = (key ^ 61U) ^ (key >> 16);
    key *= 9;
    key ^= key >> 4;
    key *= 0x27D4EB2DU;
    return key ^ (key >> 15);
}

}  // namespace

TEST_CASE("sampling: pcg4d and the pixel offset have the values of an independent implementation") {
    CHECK(pcg4d({0, 0, 0, 0}) == HashWords{251852841U, 760645481U, 850445371U, 3542436074U});
    CHECK(pcg4d({1, 2, 3, 4}) == HashWords{908250390U, 4044648920U, 3775961919U, 45698095U});
    CHECK(pcg4d({~0U, ~0U, ~0U, ~0U}) == HashWords{2538526866U, 3222658151U, 2677364576U, 2713428488U});
    CHECK(pixel_offset(HashKey(0, HashPurpose::pixel_offset), 0, 0) == 2175003414U);
    CHECK(pixel_offset(HashKey(1, HashPurpose::pixel_offset), 2, 3) == 1936713873U);
    CHECK(pixel_offset(HashKey((1ULL << 63) + 5, HashPurpose::pixel_offset), ~0U, 1023) == 1248155805U);
}

TEST_CASE("sampling: pixel offsets are uniform over the pixels in every dimension and seed tried") {
    for (const std::uint64_t seed : {0ULL, 1ULL, 2ULL, 1ULL << 32, ~0ULL}) {
        const HashKey key(seed, HashPurpose::pixel_offset);
        for (const std::uint32_t d : {0U, 1U, 2U, 25U, 1023U}) {
            CHECK(chi_square([&](std::uint32_t p) { return pixel_offset(key, p, d) >> 24; }) < six_sigma);
            CHECK(chi_square([&](std::uint32_t p) { return pixel_offset(key, p, d) & 255U; }) < six_sigma);
        }
    }
}

TEST_CASE("sampling: pixel offsets of two dimensions are independent, those of a Wang hash of dimension^seed are not") {
    for (const std::uint64_t seed : {0ULL, 1ULL, 77ULL}) {
        const HashKey key(seed, HashPurpose::pixel_offset);
        for (std::uint32_t a = 0; a < 8; ++a) {
            for (std::uint32_t b = a + 1; b < 8; ++b) {
                CHECK(chi_square([&](std::uint32_t p) {
                          return cell(pixel_offset(key, p, a), pixel_offset(key, p, b));
                      }) < six_sigma);
            }
        }
    }
    // The test sees the trap: Wang, dimensions 0 and 2, the pixel hashed first to get its seed.
    const double trap = chi_square([](std::uint32_t p) { return cell(wang(0 ^ wang(p)), wang(2 ^ wang(p))); });
    CHECK(trap > 50000);
}

TEST_CASE("sampling: pixel offsets of neighbouring pixels are uncorrelated") {
    const HashKey key(3, HashPurpose::pixel_offset);
    for (const std::uint32_t d : {0U, 1U, 7U}) {
        for (const std::uint32_t distance : {1U, 2U, 64U, 1024U, 1920U}) {  // to the right, and one row down
            CHECK(chi_square([&](std::uint32_t p) {
                      return cell(pixel_offset(key, p, d), pixel_offset(key, p + distance, d));
                  }) < six_sigma);
            double covariance = 0;
            for (std::uint32_t p = 0; p < samples; ++p) {
                covariance +=
                    (pixel_offset(key, p, d) * 0x1p-32 - 0.5) * (pixel_offset(key, p + distance, d) * 0x1p-32 - 0.5);
            }
            const double correlation = 12 * covariance / samples;
            CHECK(std::abs(correlation) < 5 / std::sqrt(double{samples}));
        }
    }
}

TEST_CASE("sampling: seeds that differ in one bit, low or high, and other purposes give unrelated offsets") {
    const HashKey base(12, HashPurpose::pixel_offset);
    for (const HashKey& other :
         {HashKey(13, HashPurpose::pixel_offset), HashKey(12 + (1ULL << 32), HashPurpose::pixel_offset),
          HashKey(12, HashPurpose::independent), HashKey(12, HashPurpose::sample_indices)}) {
        CHECK(chi_square([&](std::uint32_t p) { return cell(pixel_offset(base, p, 0), pixel_offset(other, p, 0)); }) <
              six_sigma);
    }
}
