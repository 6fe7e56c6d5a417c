// What a comparison may claim: the level, the cause and the words of a verdict.
#include "cachesim/report/verdict.hpp"

#include <catch2/catch.hpp>

using namespace raycache::cachesim;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;

namespace {

Estimate estimate(double mean, double half_width) { return {mean, half_width}; }

/// L2-to-L1 bytes, DRAM bytes; half of the L2-to-L1 ratio is L1's.
Difference difference(const Estimate& l2, const Estimate& dram) {
    Difference d;
    d.bytes = {l2, dram};
    d.traced = 4;
    d.spp = 64;
    d.factors = Factors{std::vector<Estimate>(5, {1, {}}), {1, {}}, {l2, dram}};
    return d;
}

}  // namespace

TEST_CASE("a verdict speaks of L2-to-L1 bytes where these differ for certain and DRAM bytes do not") {
    const Verdict v = verdict(difference(estimate(0.43, 0.06), estimate(0.99, 0.05)));
    CHECK(v.level == "l2_bytes");
    CHECK_THAT(v.text, StartsWith("57.0 ±6.0 % fewer L2-to-L1 bytes/ray, most by L1 locality, x0.430 ±0.060 ("));
    CHECK_THAT(v.text, !Contains("no certain") && !Contains("DRAM"));
}

TEST_CASE("predicted time comes first where it is certain, and is not claimed where it is not") {
    Difference d = difference(estimate(0.43, 0.06), estimate(0.99, 0.05));
    d.speed_up = estimate(1.48, 0.05);
    CHECK(verdict(d).level == "time");
    CHECK_THAT(verdict(d).text,
               StartsWith("1.48 ±0.05 times as fast (predicted); 57.0 ±6.0 % fewer L2-to-L1 bytes/ray"));
    d.speed_up = estimate(1.02, 0.05);
    CHECK(verdict(d).level == "l2_bytes");
    CHECK_THAT(verdict(d).text, StartsWith("57.0 ±6.0 % fewer"));
    CHECK_THAT(verdict(d).text, Contains("no certain difference in time: 0.97 to 1.07 times as fast (predicted)"));
    d = difference(estimate(0.97, 0.06), estimate(0.99, 0.05));
    d.speed_up = estimate(1.2, 0.05);
    CHECK_THAT(verdict(d).text, StartsWith("1.20 ±0.05 times as fast (predicted); no certain difference in bytes: "));
}

TEST_CASE("DRAM bytes lead where they alone are certain, and compulsory ones are called so") {
    Difference d = difference(estimate(0.97, 0.06), estimate(0.8, 0.05));
    CHECK(verdict(d).level == "dram_bytes");
    CHECK_THAT(verdict(d).text, StartsWith("20.0 ±5.0 % fewer DRAM bytes/ray, most by cache locality"));
    d.dram_compulsory_share = 0.99;
    CHECK_THAT(verdict(d).text, StartsWith("20.0 ±5.0 % fewer DRAM bytes/ray (compulsory misses of cold launches)"));
}

TEST_CASE("an L3 is a level of its own") {
    Difference d = difference(estimate(0.97, 0.06), estimate(0.99, 0.05));
    d.bytes.insert(d.bytes.begin() + 1, estimate(1.3, 0.1));
    d.factors->locality.insert(d.factors->locality.begin() + 1, d.bytes[1]);
    CHECK(verdict(d).level == "l3_bytes");
    CHECK_THAT(verdict(d).text, StartsWith("30.0 ±10.0 % more L3-to-L2 bytes/ray, most by cache locality"));
}

TEST_CASE("where nothing is certain the verdict says how large it could be and what to raise") {
    const Verdict v = verdict(difference(estimate(0.955, 0.075), estimate(0.99, 0.1)));
    CHECK_FALSE(v.level);
    CHECK_THAT(v.text, StartsWith("no certain difference; at most 12.0 % fewer to 3.0 % more L2-to-L1 bytes/ray, "
                                  "11.0 % fewer to 9.0 % more DRAM bytes/ray; raise --trace-samples from 4 to about "));
    CHECK_THAT(v.text, !Contains("most by"));
    // A half width of 1.67 times the difference: (0.075 / 0.045)^2 x 4 indices.
    CHECK_THAT(v.text, Contains("about 13"));
    CHECK_THAT(verdict(difference(estimate(0.999, 0.1), estimate(1, 0.1))).text, Contains("from 4 towards all 64"));
    Difference all = difference(estimate(0.999, 0.1), estimate(1, 0.1));
    all.traced = 64;
    CHECK_THAT(verdict(all).text, Contains("raise the resolution"));
}

TEST_CASE("one sample index proves nothing but is reported") {
    Difference d = difference({0.64, {}}, {0.9, {}});
    d.traced = 1;
    const Verdict v = verdict(d);
    CHECK_FALSE(v.level);
    CHECK_THAT(v.text, StartsWith("36.0 % fewer L2-to-L1 bytes/ray, most by L1 locality, x0.640 ("));
    CHECK_THAT(v.text, Contains("from one sample index, so without an interval"));
}

TEST_CASE("equal counts are no difference, and a cause that is not certain is only perhaps one") {
    CHECK(verdict(difference({1, 0}, {1, 0})).text == "no difference in bytes/ray");
    Difference d = difference(estimate(0.8, 0.1), estimate(1, 0.1));
    d.factors->locality[0] = estimate(0.9, 0.2);
    d.factors->terms[1] = estimate(0.95, 0.01);
    CHECK_THAT(verdict(d).text, Contains("most perhaps by L1 locality, x0.900 ±0.200"));
    CHECK(verdict(Difference{}).text == "nothing to compare: no traffic");
}
