// What the registry says about which parameter a decorrelation reads, held against its values.
#include <catch2/catch.hpp>
#include <functional>

#include "tracer/sampling/sampling_strategy.hpp"

using namespace raycache::tracer;

namespace {

StrategySettings settings_of(const std::string& decorrelation, bool with_mu) {
    StrategySettings settings;
    settings.decorrelation = decorrelation;
    settings.sequence = "sobol";
    settings.samples.spp = 1024;
    settings.samples.width = 64;
    if (with_mu) settings.parameters.mu = 0.5;
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

struct Change {
    Parameter parameter;
    std::function<void(StrategySettings&)> apply;
};

const std::vector<Change> changes{
    {Parameter::sequence, [](auto& s) { s.sequence = "sobol-owen-4d"; }},
    {Parameter::seed, [](auto& s) { s.samples.seed = 9; }},
    {Parameter::k, [](auto& s) { s.parameters.k = 1.7; }},
    {Parameter::s, [](auto& s) { s.parameters.s = 3; }},
    {Parameter::mu, [](auto& s) { s.parameters.mu = 0.3; }},
    {Parameter::interleave, [](auto& s) { s.parameters.interleave = 5; }},
    {Parameter::cycles_multiplier, [](auto& s) { s.parameters.cycles.multiplier = 0.5; }},
    {Parameter::cycles_min_samples, [](auto& s) { s.parameters.cycles.min_samples = 20; }},
    {Parameter::cycles_noise_threshold, [](auto& s) { s.parameters.cycles.noise_threshold = 0.1; }},
};

}  // namespace

TEST_CASE("sampling: a decorrelation reads the parameters that its entry names, and no other", "[slow]") {
    for (const DecorrelationEntry& entry : decorrelations())
        for (const bool with_mu : {false, true})
            for (const Change& change : changes) {
                INFO(entry.name << (with_mu ? " with mu, " : ", ") << to_string(change.parameter));
                const StrategySettings before = settings_of(entry.name, with_mu);
                StrategySettings after = before;
                change.apply(after);
                CHECK(entry.reads_parameter(change.parameter, after.parameters) == !same_values(before, after));
            }
}

TEST_CASE("sampling: of Blender's settings, the noise threshold and the minimum samples rule each other out") {
    const DecorrelationEntry& entry = find_decorrelation("scrambling-distance");
    DecorrelationSettings settings;
    settings.cycles.min_samples = 24;
    CHECK_FALSE(entry.reads_parameter(Parameter::cycles_noise_threshold, settings));
    CHECK(entry.reads_parameter(Parameter::cycles_min_samples, settings));
    settings.cycles.noise_threshold.reset();  // no adaptive sampling
    CHECK(entry.reads_parameter(Parameter::cycles_noise_threshold, settings));
    CHECK_FALSE(entry.reads_parameter(Parameter::cycles_min_samples, settings));
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
