// What the registry says about which parameter a decorrelation reads, held against its values.
#include <catch2/catch.hpp>
#include <string>
#include <utility>
#include <vector>

#include "tracer/sampling/sampling_strategy.hpp"

using namespace raycache::tracer;

namespace {

StrategySettings settings_of(const std::string& decorrelation, bool with_mu) {
    StrategySettings settings;
    settings.decorrelation = decorrelation;
    settings.sequence = "sobol";
    settings.samples.spp = 1024;
    settings.samples.width = 64;
    if (with_mu) settings.parameters.set("mu", 0.5);
    return settings;
}

bool same_values(const StrategySettings& a, const StrategySettings& b) {
    const SamplingStrategy first(a, 22), second(b, 22);
    for (const std::uint32_t index : {1U, 5U, 700U}) {
        const auto x = first.base_point(index), y = second.base_point(index);
        for (std::uint32_t pixel = 0; pixel < 300; ++pixel)
            for (std::uint32_t d = 0; d < 22; ++d)
                if (first.value(x[d], pixel, index, d) != second.value(y[d], pixel, index, d)) return false;
    }
    return true;
}

/// Another value of each parameter there is.
const std::vector<std::pair<std::string, std::string>> changes{
    {"k", "1.7"},
    {"s", "3"},
    {"mu", "0.3"},
    {"interleave", "5"},
    {"share", "light0"},
    {"share-bits", "3"},
    {"cycles-multiplier", "0.5"},
    {"cycles-min-samples", "20"},
    {"cycles-noise-threshold", "0.1"},
};

}  // namespace

TEST_CASE("sampling: a decorrelation reads the parameters that its entry names, and no other", "[slow]") {
    REQUIRE(changes.size() == parameter_names().size());
    for (const DecorrelationEntry& entry : decorrelations())
        for (const bool with_mu : {false, true}) {
            const StrategySettings before = settings_of(entry.name, with_mu);
            for (const auto& [name, value] : changes) {
                INFO(entry.name << (with_mu ? " with mu, " : ", ") << name);
                StrategySettings after = before;
                after.parameters.set(name, value);
                CHECK(entry.reads_parameter(name, after.parameters) == !same_values(before, after));
                CHECK((entry.has_parameter(name) || !entry.reads_parameter(name, after.parameters)));
            }
            StrategySettings other_sequence = before, other_seed = before;
            other_sequence.sequence = "sobol-owen-4d";
            other_seed.samples.seed = 9;
            INFO(entry.name);
            CHECK(entry.reads_sequence == !same_values(before, other_sequence));
            CHECK(entry.reads_seed == !same_values(before, other_seed));
        }
}

TEST_CASE("sampling: the fallback of a parameter is what it is where it is not given") {
    for (const DecorrelationEntry& entry : decorrelations())
        for (const ParameterEntry& parameter : entry.parameters) {
            INFO(entry.name << ", " << parameter.name);
            CHECK(std::string(parameter.description).size() > 0);
            const StrategySettings before = settings_of(entry.name, false);
            StrategySettings after = before;
            if (std::string(parameter.fallback).empty()) continue;
            after.parameters.set(parameter.name, parameter.fallback);
            CHECK(same_values(before, after));
        }
}

TEST_CASE("sampling: a parameter that no decorrelation has is refused with the one that was meant") {
    Parameters parameters;
    parameters.set("interleaf", 8);
    CHECK_THROWS_WITH(check_parameters(parameters), Catch::Contains("unknown parameter 'interleaf'") &&
                                                        Catch::Contains("did you mean 'interleave'?"));
}

TEST_CASE("sampling: a value that a parameter cannot have is refused, whoever reads it") {
    const auto [name, value] = GENERATE(table<std::string, std::string>({{"k", "wide"},
                                                                         {"k", "-1"},
                                                                         {"k", "2.5x"},
                                                                         {"k", ""},
                                                                         {"k", "full"},
                                                                         {"s", "2.5"},
                                                                         {"s", "0"},
                                                                         {"s", "4294967296"},
                                                                         {"mu", "off"},
                                                                         {"interleave", "257"},
                                                                         {"cycles-noise-threshold", "1.1"}}));
    Parameters parameters;
    parameters.set(name, value);
    CHECK_THROWS_WITH(check_parameters(parameters), Catch::Contains("must be") && Catch::Contains("found " + value));
}

TEST_CASE("sampling: of Blender's settings, the noise threshold and the minimum samples rule each other out") {
    const DecorrelationEntry& entry = find_decorrelation("scrambling-distance");
    Parameters given;
    given.set("cycles-min-samples", 24);
    CHECK_FALSE(entry.reads_parameter("cycles-noise-threshold", given));
    CHECK(entry.reads_parameter("cycles-min-samples", given));
    given.set("cycles-noise-threshold", "off");
    CHECK(entry.reads_parameter("cycles-noise-threshold", given));
    CHECK_FALSE(entry.reads_parameter("cycles-min-samples", given));
}

TEST_CASE("sampling: a sequence depends on the seed where its entry says so") {
    for (const SequenceEntry& entry : sequences()) {
        StrategySettings before = settings_of("coherent", false);
        before.sequence = entry.name;
        StrategySettings after = before;
        after.samples.seed = 9;
        INFO(entry.name);
        CHECK(entry.reads_seed == !same_values(before, after));
    }
}

TEST_CASE("sampling: an N between two powers of two is pointed out for nets, and only there") {
    const auto lines = [](const std::string& sequence, const std::string& decorrelation, std::uint64_t n) {
        StrategySettings settings = settings_of(decorrelation, false);
        settings.sequence = sequence;
        settings.samples.spp = n;
        return SamplingStrategy(settings, 22).warnings();
    };
    for (const char* net : {"sobol", "sobol-owen-02", "sobol-owen-4d", "pmj02"}) {
        CHECK_THAT(lines(net, "cranley-patterson", 100).at(0), Catch::Contains("choose 64 or 128"));
        CHECK(lines(net, "cranley-patterson", 128).empty());
        CHECK(lines(net, "random", 100).empty());  // does not read the sequence
    }
    for (const char* other : {"halton", "halton-scrambled", "r2", "random"})
        CHECK(lines(other, "cranley-patterson", 100).empty());
    CHECK_FALSE(lines("sobol", "owen", 100).empty());
}
