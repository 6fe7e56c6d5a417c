// Any sequence with any decorrelation: which pairs are defined, what the others say, and the ends of every range.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <set>

#include "tracer/sampling/sampling_strategy.hpp"
#include "traces/error.hpp"

using namespace raycache;
using namespace raycache::tracer;

namespace {

StrategySettings settings_of(const std::string& sequence, const std::string& decorrelation, std::uint64_t spp) {
    StrategySettings settings;
    settings.sequence = sequence;
    settings.decorrelation = decorrelation;
    settings.samples.spp = spp;
    settings.samples.width = 64;
    return settings;
}

void check_refused(const StrategySettings& settings, const std::string& words, std::uint32_t dimensions = 26) {
    CHECK_THROWS_AS(SamplingStrategy(settings, dimensions), UsageError);
    CHECK_THROWS_WITH(SamplingStrategy(settings, dimensions), Catch::Contains(words) && !Catch::Contains("\n"));
}

}  // namespace

TEST_CASE("sampling: every pair is defined, except nets in base 2 for sequences that are none; those say why",
          "[slow]") {
    const std::set<std::string> no_nets{"halton", "halton-scrambled", "r2", "random"};
    const std::set<std::string> need_nets{"uniform-jitter", "owen", "net-micro-jitter", "net-micro-jitter-fast"};
    for (const auto& sequence : sequences())
        for (const auto& decorrelation : decorrelations()) {
            const auto settings = settings_of(sequence.name, decorrelation.name, 64);
            const bool undefined = no_nets.count(sequence.name) != 0 && need_nets.count(decorrelation.name) != 0;
            INFO(sequence.name << " x " << decorrelation.name);
            if (undefined) {
                check_refused(settings, "found sequence '" + sequence.name + "'");
                check_refused(settings, decorrelation.name + " ");
                check_refused(settings, "sobol-owen-4d");  // the remedy names sequences that do
            } else {
                CHECK_NOTHROW(SamplingStrategy(settings, 26));
            }
        }
}

TEST_CASE("sampling: N that is no power of two is refused where a whole net is needed, with both neighbours") {
    for (const std::string decorrelation : {"uniform-jitter", "net-micro-jitter", "net-micro-jitter-fast"})
        check_refused(settings_of("sobol", decorrelation, 100), "found 100: give N = 64 or 128");
    for (const std::string decorrelation : {"owen", "blue-noise", "interleaved", "scrambling-distance"})
        CHECK_NOTHROW(SamplingStrategy(settings_of("sobol", decorrelation, 100), 26));
}

TEST_CASE("sampling: strategies that depend on a pixel's place are refused without the picture's width") {
    for (const std::string decorrelation : {"interleaved", "blue-noise", "net-micro-jitter-fast"}) {
        auto settings = settings_of("sobol", decorrelation, 64);
        settings.samples.width = 0;
        check_refused(settings, "width");
    }
}

TEST_CASE("sampling: every defined pair works at the last index, at N = 2^31 and in dimension 1023", "[slow]") {
    for (const auto& sequence : sequences())
        for (const auto& decorrelation : decorrelations())
            for (const std::uint64_t n : {std::uint64_t{1}, std::uint64_t{1} << 31, std::uint64_t{1} << 32}) {
                INFO(sequence.name << " x " << decorrelation.name << " N " << n);
                const auto settings = settings_of(sequence.name, decorrelation.name, n);
                if (sequence.name == "pmj02" && n > 65536) {
                    check_refused(settings, "has 65536 points, found N = " + std::to_string(n));
                    continue;
                }
                try {
                    const SamplingStrategy both(settings, 1024);
                    const auto point = both.base_point(n - 1);
                    REQUIRE(point.size() == 1024);
                    const auto last = static_cast<std::uint32_t>(n - 1);
                    both.value(point[1023], 4095, last, 1023);
                    CHECK_THROWS_AS(both.base_point(n), UsageError);
                } catch (const UsageError& error) {
                    CHECK_THAT(error.what(), Catch::Contains("in base 2"));
                }
                check_refused(settings, "at most 1024, found 1025", 1025);
            }
}

TEST_CASE("sampling: s = full is all dimensions of the path, after which mu is usually clamped to 1") {
    auto settings = settings_of("sobol", "micro-jitter", 1024);
    settings.parameters.set("s", "full");
    const SamplingStrategy full(settings, 26);
    CHECK(full.parameters() == "K=2.5 s=full(26) mu=1");
    CHECK_THAT(full.warnings().at(0), Catch::Contains("clamped to 1"));
    settings.parameters.set("s", 26);
    const SamplingStrategy joint(settings, 26);
    CHECK(joint.value(5, 6, 7, 8) == full.value(5, 6, 7, 8));
    settings.parameters.set("s", "full");
    settings.parameters.set("k", 1);
    CHECK(SamplingStrategy(settings, 2).parameters() == "K=1 s=full(2) mu=0.03125");
    CHECK_THROWS_WITH(make_decorrelation("micro-jitter", settings.parameters, settings.samples),
                      Catch::Contains("s = full"));
}

TEST_CASE("sampling: K from the star discrepancy makes mu its s-th root: 2.17 for the paper's Figure 2") {
    auto settings = settings_of("halton", "micro-jitter", 128);
    settings.parameters.set("k", "discrepancy");
    CHECK_THAT(SamplingStrategy(settings, 26).parameters(), Catch::StartsWith("K=discrepancy(2.165"));
    settings.parameters.set("s", 1);
    CHECK_THAT(SamplingStrategy(settings, 26).parameters(), Catch::StartsWith("K=discrepancy(4.691"));  // its square
    settings.samples.spp = 65537;
    check_refused(settings, "for N up to 65536, found N = 65537");
    settings.decorrelation = "coherent";  // ignores K
    CHECK_NOTHROW(SamplingStrategy(settings, 26));
}
