// Base sequences: Sobol and Halton against their definitions. Against SciPy: sampling_scipy.cpp.
#include <algorithm>
#include <catch2/catch.hpp>
#include <vector>

#include "tracer/sampling/sequence.hpp"
#include "traces/error.hpp"

using namespace raycache;
using namespace raycache::tracer;

namespace {

constexpr std::uint32_t half = 0x80000000U;
constexpr std::uint32_t quarter = 0x40000000U;

}  // namespace

TEST_CASE("sampling: Sobol dimension 0 is the van der Corput sequence: the bits of the index reversed") {
    const auto sobol = make_sequence("sobol");
    CHECK(sobol->sample(0, 0) == 0);
    CHECK(sobol->sample(1, 0) == half);
    CHECK(sobol->sample(2, 0) == quarter);
    CHECK(sobol->sample(3, 0) == half + quarter);
    CHECK(sobol->sample(0xF0000001U, 0) == 0x8000000FU);
    CHECK(sobol->sample(0xFFFFFFFFU, 0) == 0xFFFFFFFFU);
}

TEST_CASE("sampling: Sobol point 0 is the origin and point 1 the centre in all 1024 dimensions") {
    const auto sobol = make_sequence("sobol");
    REQUIRE(sobol->dimensions() == 1024);
    for (std::uint32_t d = 0; d < 1024; ++d) {
        REQUIRE(sobol->sample(0, d) == 0);
        REQUIRE(sobol->sample(1, d) == half);
    }
}

TEST_CASE(
    "sampling: every aligned block of 2^m Sobol points puts one point in each elementary interval of dimensions 0, 1") {
    const auto sobol = make_sequence("sobol");
    for (unsigned m = 1; m <= 10; ++m) {
        for (const std::uint32_t block : {0U, 1U, 5U, 4194303U >> m}) {
            for (unsigned a = 0; a <= m; ++a) {
                const unsigned b = m - a;
                std::vector<int> count(std::size_t{1} << m);
                for (std::uint32_t i = block << m; i < (block + 1) << m; ++i) {
                    // Shifts in 64 bits: a or b may be 0, and a shift of 32 bits by 32 is undefined.
                    const std::uint64_t column = std::uint64_t{sobol->sample(i, 0)} >> (32 - a);
                    const std::uint64_t row = std::uint64_t{sobol->sample(i, 1)} >> (32 - b);
                    ++count[column << b | row];
                }
                REQUIRE(std::all_of(count.begin(), count.end(), [](int n) { return n == 1; }));
            }
        }
    }
}

TEST_CASE("sampling: the first 2^m Sobol points fall in 2^m different intervals in each of the 1024 dimensions") {
    const auto sobol = make_sequence("sobol");
    for (const unsigned m : {1U, 4U, 9U}) {
        for (std::uint32_t d = 0; d < 1024; ++d) {
            std::vector<bool> seen(std::size_t{1} << m);
            for (std::uint32_t i = 0; i < 1U << m; ++i) seen[sobol->sample(i, d) >> (32 - m)] = true;
            REQUIRE(std::count(seen.begin(), seen.end(), true) == 1 << m);
        }
    }
}

TEST_CASE("sampling: Halton bases 2 and 3 start with the known fractions") {
    const auto halton = make_sequence("halton");
    CHECK(halton->sample(0, 0) == 0);
    CHECK(halton->sample(1, 0) == half);
    CHECK(halton->sample(2, 0) == quarter);
    CHECK(halton->sample(3, 0) == half + quarter);
    CHECK(halton->sample(0, 1) == 0);
    CHECK(halton->sample(1, 1) == 0x55555555U);                         // 1/3
    CHECK(halton->sample(2, 1) == 0xAAAAAAAAU);                         // 2/3
    CHECK(halton->sample(3, 1) == 0x1C71C71CU);                         // 1/9
    CHECK(halton->sample(4, 1) == 0x71C71C71U);                         // 4/9
    CHECK(halton->sample(1, 1023) == (std::uint64_t{1} << 32) / 8161);  // the 1024th prime
}

TEST_CASE("sampling: Halton base 2 equals Sobol dimension 0 at every index tried") {
    const auto sobol = make_sequence("sobol");
    const auto halton = make_sequence("halton");
    for (std::uint64_t i = 0; i < 1ULL << 32; i += 65521) {
        const auto index = static_cast<std::uint32_t>(i);
        REQUIRE(halton->sample(index, 0) == sobol->sample(index, 0));
    }
}

TEST_CASE("sampling: the last index 2^32-1 and the last dimension 1023 work") {
    const auto halton = make_sequence("halton");
    REQUIRE(halton->dimensions() == 1024);
    // floor(2^32 * radical inverse), from exact integers in Python.
    CHECK(halton->sample(0xFFFFFFFFU, 0) == 0xFFFFFFFFU);
    CHECK(halton->sample(0xFFFFFFFFU, 1) == 0x34330C78U);
    CHECK(halton->sample(0xFFFFFFFFU, 255) == 0xF162A6F0U);
    CHECK(halton->sample(0xFFFFFFFFU, 1023) == 0x8948E423U);
    const auto sobol = make_sequence("sobol");
    // Natural order is linear over XOR, so the last point is the point of all the other bits plus that of bit 31.
    for (std::uint32_t d = 0; d < 1024; ++d) {
        REQUIRE(sobol->sample(0xFFFFFFFFU, d) == (sobol->sample(0x7FFFFFFFU, d) ^ sobol->sample(0x80000000U, d)));
    }
}

TEST_CASE("sampling: every registered sequence has a name, a description, and can be made by its name") {
    REQUIRE(sequences().size() >= 2);
    for (const auto& entry : sequences()) {
        CHECK_FALSE(entry.name.empty());
        CHECK_FALSE(entry.description.empty());
        CHECK(make_sequence(entry.name)->dimensions() >= 1);
        CHECK(std::count_if(sequences().begin(), sequences().end(),
                            [&](const auto& e) { return e.name == entry.name; }) == 1);
    }
}

TEST_CASE("sampling: an unknown sequence is refused in one line that lists the valid names") {
    CHECK_THROWS_AS(make_sequence("sobel"), UsageError);
    CHECK_THROWS_WITH(make_sequence("sobel"),
                      Catch::Contains("'sobel'") && Catch::Contains("sobol, halton") && !Catch::Contains("\n"));
    CHECK_THROWS_AS(make_sequence(""), UsageError);
}
