// Strategies, the conversion to float, and the choice of sample indices.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "tracer/sampling/hash.hpp"
#include "tracer/sampling/sampling_strategy.hpp"
#include "traces/error.hpp"

using namespace raycache;
using namespace raycache::tracer;

namespace {

StrategySettings strategy(const std::string& sequence, const std::string& decorrelation, std::uint64_t spp) {
    StrategySettings settings;
    settings.sequence = sequence;
    settings.decorrelation = decorrelation;
    settings.samples.spp = spp;
    return settings;
}

}  // namespace

TEST_CASE("sampling: to_unit_float never gives 1, where u * 2^-32 does for 128 inputs", "[slow]") {
    int naive_ones = 0;
    for (std::uint64_t u = 0xFFFFF000U; u < 1ULL << 32; ++u) {
        naive_ones += static_cast<float>(static_cast<std::uint32_t>(u)) * 0x1p-32F == 1.0F;
        REQUIRE(to_unit_float(static_cast<std::uint32_t>(u)) < 1.0F);
    }
    CHECK(naive_ones == 128);
    for (std::uint64_t u = 0; u < 1ULL << 32; u += 4093) {
        const float f = to_unit_float(static_cast<std::uint32_t>(u));
        REQUIRE((f >= 0.0F && f < 1.0F));
    }
    CHECK(to_unit_float(0) == 0.0F);
    CHECK(to_unit_float(255) == 0.0F);
    CHECK(to_unit_float(0x80000000U) == 0.5F);
    CHECK(to_unit_float(0xFFFFFFFFU) == std::nextafter(1.0F, 0.0F));
}

TEST_CASE("sampling: to_unit_float is below 1 and never falls for all 2^32 inputs", "[.slow]") {
    bool good = true;
    float last = 0.0F;
    for (std::uint64_t u = 0; u < 1ULL << 32; ++u) {
        const float f = to_unit_float(static_cast<std::uint32_t>(u));
        good = good && f >= last && f < 1.0F;
        last = f;
    }
    CHECK(good);
}

TEST_CASE("sampling: a strategy is its sequence followed by its decorrelation", "[slow]") {
    for (const auto& sequence : sequences()) {
        for (const auto& decorrelation : decorrelations()) {
            auto settings = strategy(sequence.name, decorrelation.name, 64);
            settings.samples.width = 64;
            settings.samples.dimensions = 26;
            const auto x = make_sequence(sequence.name, settings.samples.seed);
            std::unique_ptr<Decorrelation> y;
            try {
                y = make_decorrelation(decorrelation.name, settings.parameters, settings.samples, *x);
            } catch (const UsageError&) {  // an undefined pair: sampling_pairs.cpp
                CHECK_THROWS_AS(SamplingStrategy(settings, 26), UsageError);
                continue;
            }
            const SamplingStrategy both(settings, 26);
            CHECK(both.dimensions() == 26);
            CHECK(both.settings().sequence == sequence.name);
            CHECK(both.parameters() == y->parameters());
            for (const std::uint32_t index : {0U, 1U, 63U}) {
                const auto point = both.base_point(index);
                REQUIRE(point.size() == 26);
                for (std::uint32_t d = 0; d < 26; ++d) {
                    REQUIRE(point[d] == x->sample(index, d));
                    REQUIRE(both.value(point[d], 5, index, d) == y->apply(point[d], 5, index, d));
                }
            }
        }
    }
}

TEST_CASE("sampling: the default strategy is the paper's: Sobol, micro-jitter, K = 2.5, s = 2") {
    StrategySettings settings;
    settings.samples.spp = 1024;
    const SamplingStrategy paper(settings, 26);
    CHECK(paper.settings().sequence == "sobol");
    CHECK(paper.settings().decorrelation == "micro-jitter");
    CHECK(paper.parameters() == "K=2.5 s=2 mu=0.078125");
    CHECK(paper.warnings().empty());
    settings.samples.spp = 4;
    CHECK_THAT(SamplingStrategy(settings, 26).warnings().at(0), Catch::Contains("mu 1.25 clamped to 1"));
}

TEST_CASE("sampling: paths of 1024 dimensions are accepted and of 1025 refused in one line") {
    for (const std::string sequence : {"sobol", "halton"}) {
        CHECK(SamplingStrategy(strategy(sequence, "coherent", 4), 1024).base_point(3).size() == 1024);
        CHECK_THROWS_AS(SamplingStrategy(strategy(sequence, "coherent", 4), 1025), UsageError);
        CHECK_THROWS_WITH(SamplingStrategy(strategy(sequence, "coherent", 4), 1025),
                          Catch::Contains("at most 1024, found 1025") && !Catch::Contains("\n"));
    }
}

TEST_CASE("sampling: a sample index of N or more is refused in one line, never taken modulo") {
    const SamplingStrategy small(strategy("sobol", "coherent", 16), 2);
    CHECK_NOTHROW(small.base_point(15));
    CHECK_THROWS_AS(small.base_point(16), UsageError);
    CHECK_THROWS_WITH(small.base_point(16), Catch::Contains("N = 16, found 16") && !Catch::Contains("\n"));
    const std::uint64_t all = std::uint64_t{1} << 32;
    const SamplingStrategy large(strategy("sobol", "coherent", all), 2);
    CHECK(large.base_point(all - 1)[0] == 0xFFFFFFFFU);
    CHECK_THROWS_AS(large.base_point(all), UsageError);
    CHECK_THROWS_AS(large.base_point(~std::uint64_t{0}), UsageError);
}

TEST_CASE("sampling: chosen sample indices are distinct, ascending, below N, and a function of N, count and seed") {
    for (const std::uint64_t spp : {1ULL, 2ULL, 10ULL, 1000ULL, 16384ULL, 1ULL << 32}) {
        for (const std::uint64_t count : {1ULL, 2ULL, 9ULL, 999ULL}) {
            const auto chosen = choose_sample_indices(spp, count, 42);
            CHECK(chosen.size() == std::min(spp, count));
            CHECK(std::is_sorted(chosen.begin(), chosen.end(), std::less_equal<>()));  // strictly ascending
            CHECK(chosen.back() < spp);
            CHECK(chosen == choose_sample_indices(spp, count, 42));
        }
    }
    CHECK(choose_sample_indices(16384, 8, 0) != choose_sample_indices(16384, 8, 1));
    CHECK(choose_sample_indices(16384, 8, 0) != choose_sample_indices(16384, 8, std::uint64_t{1} << 32));
}

TEST_CASE("sampling: asking for N samples or more chooses all of them") {
    const std::vector<std::uint32_t> all{0, 1, 2, 3, 4};
    CHECK(choose_sample_indices(5, 5, 7) == all);
    CHECK(choose_sample_indices(5, 6, 7) == all);
    CHECK(choose_sample_indices(5, ~std::uint64_t{0}, 7) == all);
}

TEST_CASE("sampling: every sample index, and every pair, is chosen equally often over the seeds") {
    constexpr std::uint64_t spp = 12;
    constexpr std::uint64_t count = 4;
    constexpr int seeds = 20000;
    int single[spp] = {};
    int pairs[spp][spp] = {};
    for (int seed = 0; seed < seeds; ++seed) {
        const auto chosen = choose_sample_indices(spp, count, static_cast<std::uint64_t>(seed));
        for (const std::uint32_t a : chosen) {
            ++single[a];
            for (const std::uint32_t b : chosen) ++pairs[a][b];
        }
    }
    const auto near = [](int n, double p) { return std::abs(n - seeds * p) < 5 * std::sqrt(seeds * p * (1 - p)); };
    for (std::uint64_t a = 0; a < spp; ++a) {
        CHECK(near(single[a], 4.0 / 12));
        for (std::uint64_t b = 0; b < a; ++b) CHECK(near(pairs[a][b], 4.0 / 12 * 3 / 11));
    }
}

TEST_CASE("sampling: indices chosen out of 2^32 reach the whole range") {
    const auto chosen = choose_sample_indices(std::uint64_t{1} << 32, 1 << 20, 1);
    CHECK(chosen.size() == 1 << 20);
    CHECK(chosen.front() < 1U << 17);
    CHECK(chosen.back() > ~0U - (1U << 17));
}

TEST_CASE("sampling: impossible requests for sample indices are refused in one line") {
    CHECK_THROWS_AS(choose_sample_indices(0, 1, 0), UsageError);
    CHECK_THROWS_AS(choose_sample_indices((std::uint64_t{1} << 32) + 1, 1, 0), UsageError);
    CHECK_THROWS_AS(choose_sample_indices(16, 0, 0), UsageError);
    CHECK_THROWS_AS(choose_sample_indices(1 << 21, (1 << 20) + 1, 0), UsageError);
    CHECK_THROWS_WITH(choose_sample_indices(1 << 21, ~std::uint64_t{0}, 0),
                      Catch::Contains("at most 1048576") && Catch::Contains("found 2097152") && !Catch::Contains("\n"));
}
