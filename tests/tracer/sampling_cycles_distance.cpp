// The automatic scrambling distance against the table in Cycles' source and the arithmetic of its formula.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "tracer/sampling/cycles_distance.hpp"
#include "tracer/sampling/sampling_strategy.hpp"
#include "traces/error.hpp"

using namespace raycache;
using namespace raycache::tracer;

namespace {

SamplingStrategy strategy(const std::string& decorrelation, std::uint64_t spp, CyclesSettings cycles = {},
                          std::optional<double> mu = {}) {
    StrategySettings settings;
    settings.decorrelation = decorrelation;
    settings.samples.spp = spp;
    settings.samples.seed = 3;
    settings.parameters.set("cycles-multiplier", cycles.multiplier);
    settings.parameters.set("cycles-min-samples", cycles.min_samples);
    if (cycles.noise_threshold)
        settings.parameters.set("cycles-noise-threshold", *cycles.noise_threshold);
    else
        settings.parameters.set("cycles-noise-threshold", "off");
    if (mu) settings.parameters.set("mu", *mu);
    return {settings, 8};
}

}  // namespace

TEST_CASE("cycles: the minimum samples follow the noise threshold as in the table of its source") {
    const std::uint64_t many = 1 << 20;
    CHECK(cycles_samples({1, 0, 0.1}, many) == 32);
    CHECK(cycles_samples({1, 0, 0.01}, many) == 64);
    CHECK(cycles_samples({1, 0, 0.001}, many) == 128);
    CHECK(cycles_samples({1, 0, 1.0}, many) == 16);
    CHECK(cycles_samples({1, 0, 0.0}, many) == 128);   // automatic threshold max(0.001, 1/N)
    CHECK(cycles_samples({1, 0, 0.0}, 100) == 64);     // 1/100
    CHECK(cycles_samples({1, 24, 0.01}, many) == 24);  // given: the threshold plays no part
    CHECK(cycles_samples({1, 24, 0.1}, many) == 24);
    CHECK(cycles_samples({1, 1, 0.01}, many) == 4);    // at least 4
    CHECK(cycles_samples({1, 24, 0.01}, 16) == 16);    // never more than N
    CHECK(cycles_samples({1, 24, {}}, many) == many);  // without adaptive sampling
    CHECK(cycles_samples({}, 4096) == 64);
}

TEST_CASE("cycles: the distance is multiplier * 4 / sqrt(samples), 0.5 for 4096 samples of a default render") {
    CHECK(cycles_distance({}, 4096) == 0.5);
    CHECK(cycles_distance({}, 64) == 0.5);
    CHECK(cycles_distance({}, 16) == 1);
    CHECK(cycles_distance({}, 4) == 2);
    CHECK(cycles_distance({}, 1) == 4);
    CHECK(cycles_distance({1, 0, {}}, 4096) == 0.0625);
    CHECK(cycles_distance({0.5, 0, 0.01}, 4096) == 0.25);
    CHECK(cycles_distance({0, 0, 0.01}, 4096) == 0);
    CHECK(cycles_distance({1e-9, 0, 0.01}, 4096) == Approx(5e-10));
    CHECK(cycles_distance({1, 0, 0.1}, 4096) == Approx(4 / std::sqrt(32.0)));
}

TEST_CASE("cycles: multiplier 0 is coherent, 1e-9 moves points by less than 5e-10, and from distance 1 on it is off") {
    const auto none = strategy("scrambling-distance", 4096, {0, 0, 0.01});
    const auto tiny = strategy("scrambling-distance", 4096, {1e-9, 0, 0.01});
    const auto half = strategy("scrambling-distance", 4096);
    const auto off = strategy("scrambling-distance", 16);
    const auto rotation = strategy("cranley-patterson", 16);
    bool moved = false;
    for (std::uint32_t p = 0; p < 1000; ++p) {
        REQUIRE(none.value(7, p, 0, 3) == 7);
        REQUIRE(tiny.value(7, p, 0, 3) - 7 <= 2);  // 5e-10 of 2^32 is 2.1
        moved = moved || tiny.value(7, p, 0, 3) != 7;
        REQUIRE((half.value(7, p, 0, 3) - 7) * 0x1p-32 < 0.5);
        REQUIRE(half.value(7, p, 0, 3) - 7 == (rotation.value(7, p, 0, 3) - 7) / 2);
        REQUIRE(off.value(7, p, 0, 3) == rotation.value(7, p, 0, 3));
    }
    CHECK(moved);
    CHECK(half.warnings().empty());
    CHECK(half.parameters() == "multiplier=1 distance_samples=64 mu=0.5");
    CHECK(off.parameters() == "multiplier=1 distance_samples=16 mu=1 (off)");
    CHECK_THAT(off.warnings().at(0), Catch::Contains("Blender turns it off") && Catch::Contains("owen"));
}

TEST_CASE("cycles: a given mu takes the place of the automatic distance") {
    const auto whole = strategy("scrambling-distance", 256, {0, 0, 0.01}, 1.0);
    const auto rotation = strategy("cranley-patterson", 256);
    const auto none = strategy("scrambling-distance", 256, {}, 5e-324);
    for (std::uint32_t p = 0; p < 1000; ++p) {
        REQUIRE(whole.value(7, p, 0, 3) == rotation.value(7, p, 0, 3));
        REQUIRE(none.value(7, p, 0, 3) == 7);
    }
    CHECK(strategy("scrambling-distance", 256, {}, 0.1).parameters() == "mu=0.1");
    CHECK_THAT(strategy("scrambling-distance", 4, {}, 1.5).warnings().at(0), Catch::Contains("mu 1.5 clamped to 1"));
}

TEST_CASE("cycles: settings out of range are refused, whatever the decorrelation") {
    const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
    for (const char* name : {"scrambling-distance", "coherent"}) {
        for (const double multiplier : {-1.0, nan, infinity})
            CHECK_THROWS_AS(strategy(name, 64, {multiplier, 0, 0.01}), UsageError);
        for (const double threshold : {-0.1, 1.1, nan})
            CHECK_THROWS_AS(strategy(name, 64, {1, 0, threshold}), UsageError);
    }
}
