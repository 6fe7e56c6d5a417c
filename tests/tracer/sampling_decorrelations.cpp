// Decorrelations against their definitions, and the extremes of their settings.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <set>

#include "tracer/sampling/decorrelation.hpp"
#include "tracer/sampling/hash.hpp"
#include "tracer/sampling/sequence.hpp"
#include "traces/error.hpp"

using namespace raycache;
using namespace raycache::tracer;

namespace {

constexpr std::uint32_t half = 0x80000000U;
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

/// What make_decorrelation() is given beside a name.
struct Given {
    Parameters parameters = {};
    SampleSet samples = {};
};

std::unique_ptr<Decorrelation> make(const std::string& name, const Given& given = {}) {
    return make_decorrelation(name, given.parameters, given.samples);
}

double mu_of(const Given& given) { return *make("micro-jitter", given)->mu(); }

Given with_mu(double mu) {
    Given given;
    given.parameters.set("mu", mu);
    return given;
}

Given with_formula(double k, std::uint64_t n, unsigned s = 2) {
    Given given;
    given.parameters.set("k", k);
    given.parameters.set("s", s);
    given.samples.spp = n;
    given.samples.width = 1920;
    return given;
}

/// Calls f(x, pixel, index, dimension) for varied arguments, corners of the ranges included.
template <class F>
void for_many_places(F f) {
    for (const std::uint32_t pixel : {0U, 1U, 2U, 1919U, 2073599U, ~0U}) {
        for (const std::uint32_t dimension : {0U, 1U, 25U, 1023U}) {
            for (const std::uint32_t index : {0U, 1U, 1000U, ~0U}) {
                for (const std::uint32_t x : {0U, 1U, 0x40000000U, 0x7FFFFFFFU, half, 0xC0000000U, ~0U}) {
                    f(x, pixel, index, dimension);
                }
            }
        }
    }
}

void check_equal_up_to_shift(const Decorrelation& a, const Decorrelation& b, std::uint32_t shift) {
    for_many_places(
        [&](auto x, auto p, auto i, auto d) { REQUIRE(a.apply(x, p, i, d) == b.apply(x, p, i, d) + shift); });
}

void check_refused(const Given& settings, const std::string& words) {
    for (const auto& entry : decorrelations()) {
        CHECK_THROWS_AS(make(entry.name, settings), UsageError);
        CHECK_THROWS_WITH(make(entry.name, settings), Catch::Contains(words) && !Catch::Contains("\n"));
    }
}

}  // namespace

TEST_CASE("sampling: coherent gives every pixel the base point") {
    const auto coherent = make("coherent", {});
    for_many_places([&](auto x, auto p, auto i, auto d) { REQUIRE(coherent->apply(x, p, i, d) == x); });
    CHECK(coherent->parameters().empty());
}

TEST_CASE("sampling: Cranley-Patterson adds the pixel's offset modulo 1, the same for every sample") {
    Given settings;
    settings.samples.seed = 9;
    const auto rotation = make("cranley-patterson", settings);
    const HashKey key(9, HashPurpose::pixel_offset);
    for_many_places([&](auto x, auto p, auto i, auto d) {
        REQUIRE(rotation->apply(x, p, i, d) == static_cast<std::uint32_t>(x + pixel_offset(key, p, d)));
    });
    CHECK(rotation->parameters().empty());
}

TEST_CASE("sampling: random differs for every pixel, sample and dimension, and ignores the base point") {
    const auto random = make("random", {});
    std::set<std::uint32_t> seen;
    for (std::uint32_t p = 0; p < 16; ++p) {
        for (std::uint32_t i = 0; i < 16; ++i) {
            for (std::uint32_t d = 0; d < 16; ++d) {
                seen.insert(random->apply(0, p, i, d));
                REQUIRE(random->apply(12345, p, i, d) == random->apply(0, p, i, d));
            }
        }
    }
    CHECK(seen.size() >= 4094);  // 4096 draws from 2^32 repeat at most rarely
}

TEST_CASE("sampling: micro-jitter moves a point by less than mu/2 to either side, the same for every sample") {
    for (const double mu : {0.5, 0.1, 0.01, 1e-6}) {
        const auto jitter = make("micro-jitter", with_mu(mu));
        double lowest = 0;
        double highest = 0;
        for (std::uint32_t p = 0; p < 4096; ++p) {
            const auto offset = static_cast<std::int32_t>(jitter->apply(7, p, 0, 3) - 7);
            REQUIRE(jitter->apply(0xFFFFFFF0U, p, 99, 3) ==
                    static_cast<std::uint32_t>(0xFFFFFFF0U + static_cast<std::uint32_t>(offset)));
            lowest = std::min(lowest, offset * 0x1p-32);
            highest = std::max(highest, offset * 0x1p-32);
        }
        CHECK(lowest >= -mu / 2 - 0x1p-32);
        CHECK(lowest < -0.49 * mu);
        CHECK(highest < mu / 2);
        CHECK(highest > 0.49 * mu);
    }
}

TEST_CASE("sampling: symmetric micro-jitter at Sobol point 0 wraps with probability 1/2 in each dimension") {
    const auto sobol = make_sequence("sobol");
    const auto jitter = make("micro-jitter", with_formula(2.5, 1024));
    constexpr std::uint32_t pixels = 65536;
    for (const std::uint32_t d : {0U, 1U, 2U, 25U}) {
        std::uint32_t wrapped = 0;
        for (std::uint32_t p = 0; p < pixels; ++p) wrapped += jitter->apply(sobol->sample(0, d), p, 0, d) >= half;
        CHECK(wrapped / double{pixels} == Approx(0.5).margin(0.01));  // 5 standard deviations
    }
}

TEST_CASE("sampling: mu = 0, K = 0, a denormal mu and a mu that rounds to 0 are bit-identical to coherent") {
    const auto coherent = make("coherent", {});
    for (const double mu : {0.0, -0.0, std::numeric_limits<double>::denorm_min(), 1e-300, 0x1p-34}) {
        check_equal_up_to_shift(*make("micro-jitter", with_mu(mu)), *coherent, 0);
    }
    check_equal_up_to_shift(*make("micro-jitter", with_formula(0, 16)), *coherent, 0);
    check_equal_up_to_shift(*make("micro-jitter", with_formula(5e-324, 16)), *coherent, 0);
}

TEST_CASE("sampling: mu = 1 is Cranley-Patterson up to a global shift of exactly 2^31") {
    for (const std::uint64_t seed : {0ULL, 5ULL, ~0ULL}) {
        Given settings = with_mu(1);
        settings.samples.seed = seed;
        check_equal_up_to_shift(*make("micro-jitter", settings), *make("cranley-patterson", settings), half);
    }
}

TEST_CASE("sampling: N = 1 with K >= 1 is mu = 1, Cranley-Patterson up to the shift") {
    for (const double k : {1.0, 2.5, 100.0}) {
        const auto settings = with_formula(k, 1);
        CHECK(mu_of(settings) == 1.0);
        check_equal_up_to_shift(*make("micro-jitter", settings), *make("cranley-patterson", settings), half);
    }
}

TEST_CASE("sampling: K = 4 at N = 10 asks for mu = 1.265, which is clamped to 1 with a warning") {
    const auto settings = with_formula(4, 10);
    CHECK(mu_of(settings) == 1.0);
    const auto jitter = make("micro-jitter", settings);
    check_equal_up_to_shift(*jitter, *make("micro-jitter", with_mu(1)), 0);
    CHECK_THAT(jitter->warning(), Catch::Contains("mu 1.26491 clamped to 1") && !Catch::Contains("\n"));
    CHECK_THAT(make("micro-jitter", with_mu(1.58))->warning(), Catch::Contains("mu 1.58 clamped to 1"));
    CHECK(make("micro-jitter", with_mu(1))->warning().empty());
    CHECK(make("coherent", settings)->warning().empty());
    CHECK(make("cranley-patterson", settings)->warning().empty());
}

TEST_CASE("sampling: a mu too small to move a float still jitters in fixed point") {
    constexpr float x = 0.75F;
    constexpr float mu = 5.9e-8F;
    const auto jitter = make("micro-jitter", with_mu(mu));
    std::set<std::uint32_t> fixed;
    std::set<float> floating;
    for (std::uint32_t p = 0; p < 1000; ++p) {
        fixed.insert(jitter->apply(0xC0000000U, p, 0, 0));
        const float xi = static_cast<float>(pixel_offset(HashKey(0, HashPurpose::pixel_offset), p, 0) >> 8) * 0x1p-24F;
        floating.insert(x + mu * (xi - 0.5F));
    }
    CHECK(floating.size() == 1);
    CHECK(fixed.size() > 100);
    CHECK(*fixed.begin() >= 0xC0000000U - 128);
    CHECK(*fixed.rbegin() <= 0xC0000000U + 128);
}

TEST_CASE("sampling: mu follows K * N^(-1/s)") {
    CHECK(mu_of(with_formula(2.5, 1024)) == 0.078125);
    CHECK(mu_of(with_formula(1, 64, 1)) == 1.0 / 64);
    CHECK(mu_of(with_formula(1, 4096, 3)) == Approx(1.0 / 16).epsilon(1e-14));
    CHECK(mu_of(with_formula(0.5, std::uint64_t{1} << 32, 4000000000U)) == Approx(0.5));
    CHECK(mu_of(with_formula(2.5, std::uint64_t{1} << 32)) == 2.5 / 65536);
    CHECK(mu_of(with_formula(std::numeric_limits<double>::max(), 1)) == 1.0);
    Given overridden = with_formula(2.5, 1024);
    overridden.parameters.set("mu", 0.1);
    CHECK(mu_of(overridden) == 0.1);
}

TEST_CASE(
    "sampling: the union of all pixels' jittered Sobol points is even at mu = 1 and confined to the jitter below") {
    const auto sobol = make_sequence("sobol");
    const auto count_outside = [&](const Decorrelation& jitter) {
        std::uint32_t outside = 0;  // points further than 1/32 from both points of N = 2: 0 and 1/2
        for (std::uint32_t p = 0; p < 32768; ++p) {
            for (std::uint32_t i = 0; i < 2; ++i) {
                const std::uint32_t to_point = (jitter.apply(sobol->sample(i, 0), p, i, 0) + 0x08000000U) % half;
                outside += to_point >= 0x10000000U;
            }
        }
        return outside / 65536.0;
    };
    CHECK(count_outside(*make("micro-jitter", with_mu(1))) == Approx(1 - 2.0 / 16).margin(0.01));
    CHECK(count_outside(*make("micro-jitter", with_mu(1.0 / 16))) == 0);
}

TEST_CASE("sampling: parameters say K, s and the effective mu as the user gave them") {
    CHECK(make("micro-jitter", with_formula(2.5, 1024))->parameters() == "K=2.5 s=2 mu=0.078125");
    CHECK(make("micro-jitter", with_formula(4, 10))->parameters() == "K=4 s=2 mu=1");
    CHECK(make("micro-jitter", with_mu(0.1))->parameters() == "mu=0.1");
    CHECK(make("micro-jitter", with_mu(1.58))->parameters() == "mu=1");
}

TEST_CASE("sampling: bad settings are refused in one line, whatever the decorrelation") {
    check_refused(with_formula(2.5, 0), "must be 1 to 4294967296, found 0");
    check_refused(with_formula(2.5, (std::uint64_t{1} << 32) + 1), "found 4294967297");
    check_refused(with_formula(-1, 16), "K must be a number of 0 or more, or 'discrepancy', found -1");
    check_refused(with_formula(not_a_number, 16), "found nan");
    check_refused(with_formula(infinity, 16), "found inf");
    check_refused(with_formula(2.5, 16, 0), "found 0");
    check_refused(with_mu(-0.5), "mu must be a number of 0 or more, found -0.5");
    check_refused(with_mu(not_a_number), "found nan");
    check_refused(with_mu(infinity), "found inf");
    Given classes;
    classes.parameters.set("interleave", 0);
    check_refused(classes, "must be 1 to 256, found 0");
    classes.parameters.set("interleave", 257);
    check_refused(classes, "must be 1 to 256, found 257");
    CHECK_NOTHROW(make("micro-jitter", with_formula(2.5, std::uint64_t{1} << 32)));
}

TEST_CASE("sampling: an unknown decorrelation is refused in one line that lists the valid names") {
    CHECK_THROWS_AS(make("microjitter", {}), UsageError);
    CHECK_THROWS_WITH(make("microjitter", {}),
                      Catch::Contains("'microjitter'") &&
                          Catch::Contains("coherent, cranley-patterson, micro-jitter, scrambling-distance") &&
                          !Catch::Contains("\n"));
}

TEST_CASE(
    "sampling: every registered decorrelation has a unique name, a description, and depends on nothing but its "
    "arguments") {
    REQUIRE(decorrelations().size() >= 4);
    std::set<std::string> names;
    for (const auto& entry : decorrelations()) {
        CHECK(names.insert(entry.name).second);
        CHECK_FALSE(entry.description.empty());
        const auto first = make(entry.name, with_formula(2.5, 64));
        const auto second = make(entry.name, with_formula(2.5, 64));
        check_equal_up_to_shift(*first, *second, 0);
        check_equal_up_to_shift(*first, *first, 0);
    }
}

TEST_CASE("sampling: another seed gives other values, except for coherent") {
    for (const auto& entry : decorrelations()) {
        Given settings = with_formula(2.5, 64);
        const auto a = make(entry.name, settings);
        settings.samples.seed = 1;
        const auto b = make(entry.name, settings);
        int same = 0;
        for (std::uint32_t p = 0; p < 1000; ++p) same += a->apply(0, p, 0, 0) == b->apply(0, p, 0, 0);
        CHECK(same == (entry.name == "coherent" ? 1000 : 0));
    }
}
