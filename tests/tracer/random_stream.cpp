// Whole numbers drawn from the hash.
#include "tracer/sampling/random_stream.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <set>
#include <vector>

using namespace raycache::tracer;

namespace {

std::vector<std::uint64_t> draws(RandomStream random, std::uint64_t bound, std::size_t count) {
    std::vector<std::uint64_t> all;
    for (std::size_t i = 0; i < count; ++i) all.push_back(random.below(bound));
    return all;
}

constexpr std::uint64_t whole_range = ~std::uint64_t{0};

}  // namespace

TEST_CASE("a random stream is the hash's words, two to a draw, by the remainder") {
    const HashKey key(7, HashPurpose::window_places);
    const auto drawn = draws(RandomStream(7, HashPurpose::window_places, 3), whole_range, 3);
    for (std::uint32_t i = 0; i < 3; ++i) {
        const HashWords words = key.words(i, 3, 0);
        CHECK(drawn[i] == (std::uint64_t{words[0]} << 32 | words[1]));
    }
    const auto small = draws(RandomStream(7, HashPurpose::window_places, 3), 10, 3);
    for (std::size_t i = 0; i < 3; ++i) CHECK(small[i] == drawn[i] % 10);
}

TEST_CASE("random streams repeat themselves and differ by seed, purpose and number") {
    const auto first = draws(RandomStream(1, HashPurpose::window_blocks), whole_range, 50);
    CHECK(first == draws(RandomStream(1, HashPurpose::window_blocks, 0), whole_range, 50));
    CHECK(first != draws(RandomStream(2, HashPurpose::window_blocks), whole_range, 50));
    CHECK(first != draws(RandomStream(1, HashPurpose::window_places), whole_range, 50));
    CHECK(first != draws(RandomStream(1, HashPurpose::window_blocks, 1), whole_range, 50));
    CHECK(std::set<std::uint64_t>(first.begin(), first.end()).size() == 50);
}

TEST_CASE("draws below a bound are below it, and every number comes as often as any other") {
    CHECK(draws(RandomStream(1, HashPurpose::window_blocks), 1, 20) == std::vector<std::uint64_t>(20, 0));
    for (const std::uint64_t bound : {2u, 3u, 7u, 16u}) {
        std::vector<double> found(bound, 0);
        const std::size_t count = 4000;
        for (const std::uint64_t draw : draws(RandomStream(5, HashPurpose::window_blocks), bound, count)) {
            REQUIRE(draw < bound);
            ++found[draw];
        }
        // Pearson's statistic has the mean bound - 1 and the variance 2 (bound - 1).
        const double expected = static_cast<double>(count) / static_cast<double>(bound);
        double statistic = 0;
        for (const double f : found) statistic += (f - expected) * (f - expected) / expected;
        CAPTURE(bound, statistic);
        CHECK(statistic < static_cast<double>(bound - 1) + 4 * std::sqrt(2.0 * static_cast<double>(bound - 1)));
    }
}

TEST_CASE("a bound above half the range throws away what is beyond its last multiple") {
    const std::uint64_t bound = (std::uint64_t{1} << 63) + 1;  // almost every second draw is beyond it
    const auto words = draws(RandomStream(9, HashPurpose::window_blocks), whole_range, 200);
    std::vector<std::uint64_t> kept;
    for (const std::uint64_t word : words)
        if (word < bound) kept.push_back(word);
    REQUIRE(kept.size() > 50);
    REQUIRE(kept.size() < 150);
    CHECK(draws(RandomStream(9, HashPurpose::window_blocks), bound, kept.size()) == kept);
}
