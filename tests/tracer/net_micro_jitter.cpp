// net-micro-jitter with pairs of dimensions shared: the promise is that as many bits as are free cost a pixel nothing.
#include <algorithm>
#include <bit>
#include <catch2/catch.hpp>
#include <cstdint>
#include <string>
#include <vector>

#include "tracer/sampling/decorrelations/shared_pairs.hpp"
#include "tracer/sampling/sampling_strategy.hpp"
#include "traces/error.hpp"

using namespace raycache;
using namespace raycache::tracer;

namespace {

StrategySettings settings_of(const std::string& sequence, unsigned m, const std::string& share = "first-bounce",
                             int bits = -1) {
    StrategySettings settings{sequence, "net-micro-jitter", {}, {}};
    settings.samples.spp = std::uint64_t{1} << m;
    settings.samples.seed = 3;
    settings.parameters.set("share", share);
    if (bits >= 0) settings.parameters.set("share-bits", bits);
    return settings;
}

constexpr std::uint32_t dimensions = 22;  // of a path of three bounces

std::uint32_t shared_bits(const StrategySettings& settings, std::uint32_t dimension) {
    SampleSet samples = settings.samples;
    samples.dimensions = dimensions;
    return make_decorrelation(settings.decorrelation, settings.parameters, samples,
                              *make_sequence(settings.sequence, samples.seed))
        ->shared_bits(dimension);
}

unsigned count(std::uint32_t mask) { return static_cast<unsigned>(std::popcount(mask)); }

/// Whether each joint cell of these leading bits of one pixel's points holds equally many.
bool equal_cells(const SamplingStrategy& strategy, unsigned m, std::uint32_t first, unsigned a, unsigned b) {
    if (a + b > m) return false;  // more cells than points
    std::vector<std::uint32_t> cells(std::size_t{1} << (a + b));
    for (std::uint32_t i = 0; i < 1U << m; ++i) {
        const auto base = strategy.base_point(i);
        const std::uint64_t x = strategy.value(base[first], 77, i, first),
                            y = strategy.value(base[first + 1], 77, i, first + 1);
        ++cells[(x >> (32 - a)) << b | (y >> (32 - b))];
    }
    return std::all_of(cells.begin(), cells.end(), [&](std::uint32_t n) { return n == 1U << (m - a - b); });
}

}  // namespace

TEST_CASE(
    "net-micro-jitter: joint cells of the free bits hold equally many points of a pixel, for all N to 2^16, and "
    "those of one bit more do not") {
    for (const std::string sequence : {"sobol", "sobol-owen-02", "sobol-owen-4d", "pmj02"})
        for (const std::string share : {"camera", "light0", "first-bounce"})
            for (unsigned m = 0; m <= 16; ++m) {
                const auto settings = settings_of(sequence, m, share);
                const std::uint32_t first = parse_pairs(share).front();
                const unsigned a = count(shared_bits(settings, first)), b = count(shared_bits(settings, first + 1));
                const SamplingStrategy strategy(settings, dimensions);
                INFO(sequence << " " << share << " m " << m << " bits " << a << " " << b);
                REQUIRE(strategy.warnings().empty());
                REQUIRE(equal_cells(strategy, m, first, a, b));
                REQUIRE_FALSE(equal_cells(strategy, m, first, a + 1, b));
                REQUIRE_FALSE(equal_cells(strategy, m, first, a, b + 1));
                if (sequence == "sobol-owen-02" || sequence == "pmj02") REQUIRE(a + b == m);  // (0, 2)-sequences
            }
}

TEST_CASE("net-micro-jitter: pixels have the shared bits in common; all else is as owen scrambles it") {
    const SamplingStrategy net(settings_of("sobol-owen-02", 6), dimensions);
    StrategySettings other = settings_of("sobol-owen-02", 6);
    other.decorrelation = "owen";
    const SamplingStrategy owen(other, dimensions);
    CHECK(net.parameters() == "share=first-bounce bits=6 free=6");
    for (std::uint32_t i = 0; i < 64; ++i) {
        const auto base = net.base_point(i);
        for (std::uint32_t pixel = 0; pixel < 50; ++pixel)
            for (std::uint32_t d = 0; d < dimensions; ++d) {
                const std::uint32_t shared = d == 4 || d == 5 ? ~0U << 29 : 0, y = net.value(base[d], pixel, i, d);
                REQUIRE((y & shared) == (base[d] & shared));
                REQUIRE((y & ~shared) == (owen.value(base[d], pixel, i, d) & ~shared));
            }
    }
}

TEST_CASE(
    "net-micro-jitter: an odd bit goes to one dimension of the pair, and bits that are asked for to each in turn") {
    const auto odd = settings_of("sobol-owen-02", 7);
    CHECK(count(shared_bits(odd, 4)) + count(shared_bits(odd, 5)) == 7);
    CHECK(count(shared_bits(odd, 2)) == 0);
    const auto dealt = settings_of("sobol-owen-02", 6, "first-bounce+light0", 7);
    CHECK(count(shared_bits(dealt, 4)) == 2);
    CHECK(count(shared_bits(dealt, 5)) == 2);
    CHECK(count(shared_bits(dealt, 2)) == 2);
    CHECK(count(shared_bits(dealt, 3)) == 1);
    CHECK(count(shared_bits(settings_of("sobol", 6, "first-bounce", 256), 5)) == 32);
    CHECK(SamplingStrategy(settings_of("sobol-owen-02", 6, "first-bounce", 0), dimensions).parameters() ==
          "share=first-bounce bits=0 free=6");
}

TEST_CASE("net-micro-jitter: bits that are not free are warned of: too many, of pairs of different nets, dealt badly") {
    const auto warned = [](const StrategySettings& settings) {
        const auto lines = SamplingStrategy(settings, dimensions).warnings();
        REQUIRE(lines.size() <= 1);
        if (!lines.empty()) CHECK_THAT(lines.front(), Catch::Contains("not free together (of one pair"));
        return !lines.empty();
    };
    CHECK(warned(settings_of("sobol-owen-02", 6, "first-bounce", 7)));
    CHECK_FALSE(warned(settings_of("sobol-owen-02", 6, "first-bounce", 6)));
    CHECK(warned(settings_of("sobol-owen-02", 6, "first-bounce+light0")));
    CHECK(warned(settings_of("sobol-owen-02", 6, "first-bounce+light0", 4)));  // nothing is known of two nets together
    CHECK_FALSE(warned(settings_of("sobol-owen-4d", 6, "camera+light0", 4)));  // one net of four dimensions
    CHECK_FALSE(warned(settings_of("sobol-owen-02", 6, "first-bounce+light0", 0)));
    // Where a pair is a worse net, as many bits as are free may be dealt so that they are not.
    unsigned badly = 0;
    for (unsigned m = 2; m <= 16; ++m) {
        const auto free = settings_of("sobol", m, "8");
        const unsigned all = count(shared_bits(free, 8)) + count(shared_bits(free, 9)), each = all / 2;
        const auto dealt = settings_of("sobol", m, "8", static_cast<int>(all));
        const bool is_free = equal_cells(SamplingStrategy(dealt, dimensions), m, 8, all - each, each);
        CHECK(warned(dealt) == !is_free);
        badly += !is_free;
    }
    CHECK(badly > 0);
}

TEST_CASE("net-micro-jitter: what is no pair of dimensions is refused with what is") {
    const std::string text =
        GENERATE("", "first_bounce", "5", "4+", "+4", "first-bounce,light0", "-2", "sets+4", "65536", "4 ");
    Parameters parameters;
    parameters.set("share", text);
    CHECK_THROWS_AS(check_parameters(parameters), UsageError);
    CHECK_THROWS_WITH(check_parameters(parameters),
                      Catch::Contains("camera, light0, first-bounce") && Catch::Contains("found " + text));
    parameters.set("share", "4+first-bounce");
    CHECK_THROWS_WITH(check_parameters(parameters), Catch::Contains("names dimensions 4, 5 twice"));
    CHECK_THROWS_WITH(SamplingStrategy(settings_of("sobol-owen-02", 6, "sets"), dimensions),
                      Catch::Contains("net-micro-jitter with share=sets moves points inside the cells"));
}
